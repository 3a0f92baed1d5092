// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "io/pending_file.hpp"

namespace drogue::io {

std::vector<SeriesEntry> read_series(const std::filesystem::path& series) {
  std::vector<SeriesEntry> entries;
  std::ifstream stream(series);
  if (!stream) return entries;
  try {
    const auto json = nlohmann::json::parse(stream);
    for (const auto& file : json.at("files"))
      entries.push_back({file.at("name").get<std::string>(), file.at("time").get<double>()});
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(fmt::format("{} is not a file series: {}", series.string(), error.what()));
  }
  return entries;
}

namespace {

void write_series(const std::filesystem::path& series, const std::vector<SeriesEntry>& entries) {
  nlohmann::json files = nlohmann::json::array();
  for (const SeriesEntry& entry : entries) files.push_back({{"name", entry.name}, {"time", entry.time}});
  PendingStream stream(series);
  stream.write(nlohmann::json{{"file-series-version", "1.0"}, {"files", files}}.dump(1) + "\n");
  stream.commit();
}

}  // namespace

void append_to_series(const std::filesystem::path& series, const std::string& name, double time) {
  std::vector<SeriesEntry> entries = read_series(series);
  entries.push_back({name, time});
  write_series(series, entries);
}

void cut_series(const std::filesystem::path& series, double time) {
  std::vector<SeriesEntry> entries = read_series(series);
  const auto later = std::ranges::stable_partition(entries, [&](const SeriesEntry& e) { return e.time <= time; });
  if (later.empty()) return;
  for (const SeriesEntry& entry : later) std::filesystem::remove(series.parent_path() / entry.name);
  entries.erase(later.begin(), later.end());
  write_series(series, entries);
}

}  // namespace drogue::io
