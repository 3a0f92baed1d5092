// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of numbers as comma-separated values: the history of a run, profiles, reference data.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drogue::io {

struct CsvTable {
  std::vector<std::string> names;            ///< of the columns, as in the header
  std::vector<std::vector<double>> columns;  ///< all of one length

  /// The column of that name, units in brackets left aside; null if there is none.
  const std::vector<double>* find(const std::string& name) const;
};

/// A line of names, then lines of as many numbers; what follows a # and empty lines are passed over. Throws InputError
/// "file:line: ...".
CsvTable read_csv(const std::filesystem::path& file);
/// Throws std::runtime_error naming the file.
void write_csv(const std::filesystem::path& file, const CsvTable& table);

}  // namespace drogue::io
