// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a run in one HDF5 file: named arrays with checksums. What they mean is their owners' business; names are
// paths such as "simulation/fluid/level3/moments".
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/archive.hpp"
#include "io/hdf5_file.hpp"
#include "io/pending_file.hpp"

namespace drogue::io {

/// To be raised whenever what a checkpoint holds changes its name or its meaning.
inline constexpr int checkpoint_format = 3;

/// Writes a checkpoint; nothing appears under its name before `commit`. Every member throws std::runtime_error naming
/// the file.
class CheckpointWriter : public Archive {
 public:
  explicit CheckpointWriter(const std::filesystem::path& file);

  /// Describes the run as a whole.
  void put_number(const std::string& name, double value) { file_.write_attribute<double>("/", name, {&value, 1}); }
  void commit();

 private:
  template <class T>
  void put(const std::string& path, std::span<const T> values);
  void exchange(const std::string& path, std::span<std::byte> values) override;
  void exchange(const std::string& path, std::span<double> values) override;
  void exchange(const std::string& path, std::span<std::int64_t> values) override;
  std::size_t size(const std::string& path, std::size_t own) const override;

  PendingFile pending_;
  Hdf5File file_;
};

/// Reads a checkpoint. Every member throws std::runtime_error naming the file and what is missing or damaged, and
/// InputError for what is of another size or format.
class CheckpointReader : public Archive {
 public:
  explicit CheckpointReader(const std::filesystem::path& file);

  double number(const std::string& name) const { return file_.read_attribute<double>("/", name).at(0); }

 private:
  template <class T>
  void get(const std::string& path, std::span<T> values) const;
  void exchange(const std::string& path, std::span<std::byte> values) override;
  void exchange(const std::string& path, std::span<double> values) override;
  void exchange(const std::string& path, std::span<std::int64_t> values) override;
  std::size_t size(const std::string& path, std::size_t own) const override;

  std::string name_;
  Hdf5File file_;
};

/// `folder`/checkpoint_<index, six digits>.h5
std::filesystem::path checkpoint_path(const std::filesystem::path& folder, int index);

/// The checkpoints of a folder, oldest first.
std::vector<std::filesystem::path> list_checkpoints(const std::filesystem::path& folder);

/// Removes all but the newest `keep`.
void prune_checkpoints(const std::filesystem::path& folder, std::size_t keep = 2);

}  // namespace drogue::io
