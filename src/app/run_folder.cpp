// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run_folder.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace drogue::app {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> files{"case.resolved.toml", "history.csv", "summary.json", "log.txt",
                                                "frames.csv"};
constexpr std::array<std::string_view, 3> series_prefixes{"fluid", "canopy", "checkpoint"};
constexpr std::array<std::string_view, 4> series_suffixes{".hdf", ".vtu", ".series", ".h5"};

bool belongs_to_run(const std::string& name) {
  for (std::string_view file : files) {
    if (name == file) return true;
  }
  bool prefix = false, suffix = false;
  for (std::string_view p : series_prefixes) prefix |= name.starts_with(p);
  for (std::string_view s : series_suffixes) suffix |= name.ends_with(s);
  return prefix && suffix;
}

bool is_finished(const fs::path& folder) {
  std::ifstream stream(folder / "summary.json");
  if (!stream) return false;
  const auto summary = nlohmann::json::parse(stream, nullptr, false);
  return summary.is_object() && summary.value("finished", false);
}

}  // namespace

void refuse_other_run(const fs::path& folder, bool force) {
  if (fs::exists(folder) && !fs::is_directory(folder)) {
    throw InputError(fmt::format("{} is not a folder; give another with -o", folder.string()));
  }
  if (force || !fs::exists(folder / "case.resolved.toml")) return;
  throw InputError(fmt::format("{} holds {} run; give --force to replace it, or another folder with -o",
                               folder.string(), is_finished(folder) ? "a finished" : "an unfinished"));
}

void prepare_run_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{} cannot be made: {}", folder.string(), error.message()));
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && belongs_to_run(entry.path().filename().string())) old.push_back(entry.path());
  }
  for (const fs::path& file : old) fs::remove(file);
}

}  // namespace drogue::app
