// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <system_error>

namespace drogue::io {

std::filesystem::path checkpoint_path(const std::filesystem::path& folder, int index) {
  return folder / fmt::format("checkpoint_{:06d}.h5", index);
}

std::vector<std::filesystem::path> list_checkpoints(const std::filesystem::path& folder) {
  static const std::regex pattern("checkpoint_([0-9]+)\\.h5");
  std::vector<std::pair<long, std::filesystem::path>> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    std::smatch match;
    const std::string name = entry.path().filename().string();
    if (std::regex_match(name, match, pattern)) found.emplace_back(std::stol(match[1]), entry.path());
  }
  std::sort(found.begin(), found.end());
  std::vector<std::filesystem::path> files;
  for (auto& [index, file] : found) files.push_back(std::move(file));
  return files;
}

void prune_checkpoints(const std::filesystem::path& folder, std::size_t keep) {
  const auto files = list_checkpoints(folder);
  for (std::size_t i = 0; i + keep < files.size(); ++i) std::filesystem::remove(files[i]);
}

}  // namespace drogue::io
