// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "core/error.hpp"
#include "io/pending_file.hpp"

namespace drogue::io {

namespace {

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t\r"), end = text.find_last_not_of(" \t\r");
  return begin == std::string::npos ? "" : text.substr(begin, end + 1 - begin);
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

}  // namespace

const std::vector<double>* CsvTable::find(const std::string& name) const {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (trimmed(names[i].substr(0, names[i].find('['))) == name) return &columns[i];
  }
  return nullptr;
}

CsvTable read_csv(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw InputError(fmt::format("{} cannot be read", file.string()));
  CsvTable table;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    const std::vector<std::string> cells = cells_of(line);
    if (table.names.empty()) {
      table.names = cells;
      table.columns.resize(cells.size());
      continue;
    }
    if (cells.size() != table.names.size()) {
      throw InputError(fmt::format("{}:{}: {} values; expected {}, one for each name of the first line", file.string(),
                                   number, cells.size(), table.names.size()));
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const char* end = cells[i].data() + cells[i].size();
      double value = 0.0;
      if (const auto read = std::from_chars(cells[i].data(), end, value); read.ec != std::errc() || read.ptr != end) {
        throw InputError(fmt::format("{}:{}: \"{}\" is not a number", file.string(), number, cells[i]));
      }
      table.columns[i].push_back(value);
    }
  }
  return table;
}

void write_csv(const std::filesystem::path& file, const CsvTable& table) {
  PendingStream stream(file);
  stream.write(fmt::format("{}\n", fmt::join(table.names, ",")));
  const std::size_t rows = table.columns.empty() ? 0 : table.columns.front().size();
  for (std::size_t row = 0; row < rows; ++row) {
    std::string line;
    for (const auto& column : table.columns) line += fmt::format("{}{:.9g}", line.empty() ? "" : ",", column[row]);
    stream.write(line + '\n');
  }
  stream.commit();
}

}  // namespace drogue::io
