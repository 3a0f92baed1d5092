// SPDX-License-Identifier: GPL-3.0-or-later
// The folder a run is written to.
#pragma once

#include <filesystem>
#include <string>

namespace drogue::app {

/// Throws InputError if the folder holds a run, finished or not, unless `force`; says whether it can be continued.
void refuse_other_run(const std::filesystem::path& folder, bool force);

/// Makes a folder, and keeps other runs out of it while it lives. The system lets go however the process ends.
class FolderLock {
 public:
  /// Throws InputError if another run writes to the folder, or it cannot be made.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// Removes what an earlier run left in the folder; other files stay. Throws InputError if it cannot.
void clear_run_folder(const std::filesystem::path& folder);

/// Throws InputError if it cannot.
void write_text(const std::filesystem::path& file, const std::string& text);

/// Cuts a text file of a continued run back to the first `count` lines. Throws InputError if it has fewer.
void keep_lines(const std::filesystem::path& file, int count);

}  // namespace drogue::app
