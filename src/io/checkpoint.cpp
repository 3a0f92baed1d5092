// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <regex>
#include <system_error>

#include "core/error.hpp"

namespace drogue::io {

namespace {

/// FNV-1a over words of eight bytes. The library's own checksum is twenty times slower.
std::int64_t checksum(std::span<const std::byte> bytes) {
  std::uint64_t sum = 0xcbf29ce484222325;
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min<std::size_t>(8, bytes.size() - i));
    sum = (sum ^ word) * 0x100000001b3;
  }
  return static_cast<std::int64_t>(sum);
}

}  // namespace

CheckpointWriter::CheckpointWriter(const std::filesystem::path& file)
    : pending_(file), file_(Hdf5File::create(pending_.path())) {
  put_number("format", checkpoint_format);
}

template <class T>
void CheckpointWriter::put(const std::string& path, std::span<const T> values) {
  file_.write<T>(path, values);
  const std::int64_t sum = checksum(std::as_bytes(values));
  file_.write_attribute<std::int64_t>(path, "checksum", {&sum, 1});
}

void CheckpointWriter::exchange(const std::string& path, std::span<std::byte> values) { put<std::byte>(path, values); }
void CheckpointWriter::exchange(const std::string& path, std::span<double> values) { put<double>(path, values); }
void CheckpointWriter::exchange(const std::string& path, std::span<std::int64_t> values) {
  put<std::int64_t>(path, values);
}

std::size_t CheckpointWriter::size(const std::string&, std::size_t own) const { return own; }

void CheckpointWriter::commit() {
  file_.close();
  pending_.commit();
}

CheckpointReader::CheckpointReader(const std::filesystem::path& file)
    : name_(file.string()), file_(Hdf5File::open(file)) {
  if (number("format") == checkpoint_format) return;
  throw InputError(
      fmt::format("{} is of format {}, this version of drogue reads {}", name_, number("format"), checkpoint_format));
}

template <class T>
void CheckpointReader::get(const std::string& path, std::span<T> values) const {
  if (file_.size(path) != values.size()) {
    throw InputError(fmt::format("{}: {} has {} values, not {}: the grid, a mesh or the program is another one", name_,
                                 path, file_.size(path), values.size()));
  }
  file_.read<T>(path, values);
  if (file_.read_attribute<std::int64_t>(path, "checksum").at(0) == checksum(std::as_bytes(values))) return;
  throw std::runtime_error(fmt::format("{}: {} is not what was written", name_, path));
}

void CheckpointReader::exchange(const std::string& path, std::span<std::byte> values) { get(path, values); }
void CheckpointReader::exchange(const std::string& path, std::span<double> values) { get(path, values); }
void CheckpointReader::exchange(const std::string& path, std::span<std::int64_t> values) { get(path, values); }

std::size_t CheckpointReader::size(const std::string& path, std::size_t) const { return file_.size(path); }

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
