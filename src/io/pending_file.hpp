// SPDX-License-Identifier: GPL-3.0-or-later
// Output files appear complete or not at all: they are written under a temporary name and renamed.
#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

namespace drogue::io {

/// The temporary name of a file being written. The file is removed if `commit` was not reached.
class PendingFile {
 public:
  /// Creates the folder of `file` where missing. Throws std::runtime_error naming it.
  explicit PendingFile(std::filesystem::path file);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::filesystem::path& path() const { return pending_; }  ///< where to write
  const std::filesystem::path& file() const { return file_; }     ///< the name it gets
  /// Renames to the final name, replacing what is there. Throws std::runtime_error.
  void commit();

 private:
  std::filesystem::path file_, pending_;
  bool committed_ = false;
};

/// A binary stream that throws std::runtime_error, naming the file, for whatever could not be written.
class PendingStream {
 public:
  explicit PendingStream(std::filesystem::path file);

  void write(std::string_view bytes);
  void commit();

 private:
  PendingFile pending_;
  std::ofstream stream_;
};

}  // namespace drogue::io
