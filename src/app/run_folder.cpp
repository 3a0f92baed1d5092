// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "io/checkpoint.hpp"

namespace drogue::app {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> files{"case.resolved.toml", "history.csv", "summary.json", "log.txt",
                                                "frames.csv"};
constexpr std::array<std::string_view, 4> series_prefixes{"fluid", "canopy", "checkpoint", "profile_"};
constexpr std::array<std::string_view, 6> series_suffixes{".csv", ".hdf", ".vtu", ".series", ".h5", ".part"};

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
  const bool finished = is_finished(folder), can_continue = !io::list_checkpoints(folder).empty();
  throw InputError(fmt::format("{} holds {} run; give {}--force to replace it, or another folder with -o",
                               folder.string(), finished ? "a finished" : "an unfinished",
                               !finished && can_continue ? "--continue to go on with it, " : ""));
}

FolderLock::FolderLock(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{} cannot be made: {}", folder.string(), error.message()));
  descriptor_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  // some network file systems know no locks
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close(descriptor_);
  throw InputError(fmt::format("another run writes to {}; give another folder with -o", folder.string()));
}

FolderLock::~FolderLock() { close(descriptor_); }

void clear_run_folder(const fs::path& folder) {
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && belongs_to_run(entry.path().filename().string())) old.push_back(entry.path());
  }
  std::error_code error;
  for (const fs::path& file : old) {
    if (!fs::remove(file, error) && error) {
      throw InputError(fmt::format("{} of an earlier run cannot be removed: {}", file.string(), error.message()));
    }
  }
}

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text << std::flush;
  if (!stream) throw InputError(fmt::format("{} cannot be written", file.string()));
}

void keep_lines(const fs::path& file, int count) {
  std::ifstream stream(file);
  std::string line;
  for (int i = 0; i < count; ++i) {
    if (std::getline(stream, line)) continue;
    throw InputError(fmt::format("{} has {} lines but had {} at the checkpoint; give --force to start again",
                                 file.string(), i, count));
  }
  fs::resize_file(file, static_cast<std::uintmax_t>(stream.tellg()));
}

}  // namespace drogue::app
