// SPDX-License-Identifier: GPL-3.0-or-later
// A container for the state of a run: named arrays and numbers in one HDF5 file. What they mean is their owners'
// business; names are paths such as "lbm/level3/moments".
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/hdf5_file.hpp"
#include "io/pending_file.hpp"

namespace drogue::io {

/// Writes a checkpoint; nothing appears under its name before `commit`. T is float, double, std::int32_t, std::int64_t
/// or std::byte. Every member throws std::runtime_error naming the file.
class CheckpointWriter {
 public:
  explicit CheckpointWriter(const std::filesystem::path& file)
      : pending_(file), file_(Hdf5File::create(pending_.path())) {}

  template <class T>
  void put(const std::string& name, std::span<const T> values) {
    file_.write<T>(name, values);
  }
  template <class T>
  void put(const std::string& name, const std::vector<T>& values) {
    file_.write<T>(name, values);
  }
  /// Numbers and text that describe the run as a whole.
  void put_number(const std::string& name, double value) { file_.write_attribute<double>("/", name, {&value, 1}); }
  void put_text(const std::string& name, const std::string& text) { file_.write_attribute("/", name, text); }

  void commit() {
    file_.close();
    pending_.commit();
  }

 private:
  PendingFile pending_;
  Hdf5File file_;
};

/// Reads a checkpoint. Every member throws std::runtime_error naming the file and what is missing or of another size.
class CheckpointReader {
 public:
  explicit CheckpointReader(const std::filesystem::path& file) : file_(Hdf5File::open(file)) {}

  bool has(const std::string& name) const { return file_.has(name); }
  std::size_t size(const std::string& name) const { return file_.size(name); }  ///< number of values
  template <class T>
  std::vector<T> get(const std::string& name) const {
    return file_.read<T>(name);
  }
  /// Into memory that is already there; the sizes must agree.
  template <class T>
  void get(const std::string& name, std::span<T> values) const {
    file_.read<T>(name, values);
  }
  double number(const std::string& name) const { return file_.read_attribute<double>("/", name).at(0); }
  std::string text(const std::string& name) const { return file_.read_text_attribute("/", name); }

 private:
  Hdf5File file_;
};

/// `folder`/checkpoint_<index, six digits>.h5
std::filesystem::path checkpoint_path(const std::filesystem::path& folder, int index);

/// The checkpoints of a folder, oldest first.
std::vector<std::filesystem::path> list_checkpoints(const std::filesystem::path& folder);

/// Removes all but the newest `keep`.
void prune_checkpoints(const std::filesystem::path& folder, std::size_t keep = 2);

}  // namespace drogue::io
