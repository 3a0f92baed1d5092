// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/result_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

#include "core/error.hpp"

namespace drogue::bench {

namespace {

/// RFC 4180: a cell with a comma or a quote stands in quotes. Cells hold no line breaks.
std::string line_of(const Row& row) {
  std::string line;
  for (const std::string& cell : row) {
    if (&cell != &row.front()) line += ',';
    if (cell.find_first_of(",\"") == std::string::npos) {
      line += cell;
      continue;
    }
    line += '"';
    for (const char c : cell) line += c == '"' ? "\"\"" : std::string(1, c);
    line += '"';
  }
  return line + '\n';
}

Row cells_of(const std::string& line) {
  Row row(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      row.back() += line[++i];
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      row.emplace_back();
    } else {
      row.back() += line[i];
    }
  }
  return row;
}

}  // namespace

std::string number(std::optional<double> value) { return value ? fmt::format("{:.6g}", *value) : ""; }

ResultTable::ResultTable(std::filesystem::path file, Row columns, Start start)
    : file_(std::move(file)), columns_(std::move(columns)) {
  std::ifstream stream(file_);
  std::string line;
  const bool exists = start == go_on && std::getline(stream, line);
  if (exists && cells_of(line) != columns_) {
    throw InputError(fmt::format("{} has other columns, so it is of another version; move it away", file_.string()));
  }
  while (exists && std::getline(stream, line)) {
    Row row = cells_of(line);
    // the last line of a process that was killed may be half a line
    if (row.size() == columns_.size()) rows_.push_back(std::move(row));
  }
  std::ofstream out(file_);
  out << line_of(columns_);
  for (const Row& row : rows_) out << line_of(row);
  if (!out.flush()) throw InputError(fmt::format("{} cannot be written", file_.string()));
}

bool ResultTable::has(const Row& key) const {
  return std::ranges::any_of(rows_, [&](const Row& row) { return std::equal(key.begin(), key.end(), row.begin()); });
}

void ResultTable::append(const Row& row) {
  rows_.push_back(row);
  std::ofstream out(file_, std::ios::app);
  out << line_of(row);
  if (!out.flush()) throw InputError(fmt::format("{} cannot be written", file_.string()));
}

const std::string& ResultTable::text(const Row& row, const std::string& column) const {
  return row.at(std::ranges::find(columns_, column) - columns_.begin());
}

std::optional<double> ResultTable::value(const Row& row, const std::string& column) const {
  const std::string& cell = text(row, column);
  return cell.empty() ? std::nullopt : std::optional(std::stod(cell));
}

std::string markdown(const Row& columns, const std::vector<Row>& rows) {
  std::string text = fmt::format("| {} |\n|", fmt::join(columns, " | "));
  for (std::size_t i = 0; i < columns.size(); ++i) text += "---|";
  for (const Row& row : rows) text += fmt::format("\n| {} |", fmt::join(row, " | "));
  return text + '\n';
}

}  // namespace drogue::bench
