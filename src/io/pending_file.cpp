// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/pending_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace drogue::io {

PendingFile::PendingFile(std::filesystem::path file) : file_(std::move(file)), pending_(file_) {
  pending_ += ".part";
  std::error_code error;
  if (file_.has_parent_path()) std::filesystem::create_directories(file_.parent_path(), error);
  if (error)
    throw std::runtime_error(fmt::format("cannot create the folder of {}: {}", file_.string(), error.message()));
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove(pending_, ignored);
}

void PendingFile::commit() {
  std::error_code error;
  std::filesystem::rename(pending_, file_, error);
  if (error) throw std::runtime_error(fmt::format("cannot write {}: {}", file_.string(), error.message()));
  committed_ = true;
}

namespace {
[[noreturn]] void fail(const std::filesystem::path& file) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", file.string(), std::strerror(errno)));
}
}  // namespace

PendingStream::PendingStream(std::filesystem::path file) : pending_(std::move(file)) {
  stream_.open(pending_.path(), std::ios::binary);
  if (!stream_) fail(pending_.file());
}

void PendingStream::write(std::string_view bytes) {
  if (!stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()))) fail(pending_.file());
}

void PendingStream::commit() {
  stream_.close();
  if (!stream_) fail(pending_.file());
  pending_.commit();
}

}  // namespace drogue::io
