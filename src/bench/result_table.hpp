// SPDX-License-Identifier: GPL-3.0-or-later
// Results of a benchmark in a CSV file that grows by a row whenever a run is done, so that one that was stopped goes on
// where it was.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drogue::bench {

using Row = std::vector<std::string>;

/// How a number stands in a table: as many digits as tell it from its neighbours, nothing if there is none.
std::string number(std::optional<double> value);

class ResultTable {
 public:
  enum Start { go_on, anew };
  /// Keeps the rows that the file has, or starts anew. Throws InputError if it has other columns, or cannot be written.
  ResultTable(std::filesystem::path file, Row columns, Start start = go_on);

  /// Whether there is a row that begins with these cells.
  bool has(const Row& key) const;
  /// Adds a finished row, also to the file. Throws InputError if it cannot be written.
  void append(const Row& row);

  const Row& columns() const { return columns_; }
  const std::vector<Row>& rows() const { return rows_; }
  const std::string& text(const Row& row, const std::string& column) const;
  std::optional<double> value(const Row& row, const std::string& column) const;

 private:
  std::filesystem::path file_;
  Row columns_;
  std::vector<Row> rows_;
};

/// Rows as a table of Markdown.
std::string markdown(const Row& columns, const std::vector<Row>& rows);

}  // namespace drogue::bench
