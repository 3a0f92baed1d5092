// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5's C interface with handles that close themselves and failures that throw std::runtime_error.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace drogue::io {

/// Owns an HDF5 identifier.
class Hdf5Handle {
 public:
  using Closer = herr_t (*)(hid_t);

  Hdf5Handle(hid_t id, Closer closer) : id_(id), closer_(closer) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), closer_(other.closer_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept;
  ~Hdf5Handle() { close(); }

  operator hid_t() const { return id_; }
  /// False if the library could not close it (for a file: could not write what was left).
  bool close();

 private:
  hid_t id_;
  Closer closer_;
};

template <class T>
hid_t hdf5_type() {
  if constexpr (std::is_same_v<T, float>)
    return H5T_NATIVE_FLOAT;
  else if constexpr (std::is_same_v<T, double>)
    return H5T_NATIVE_DOUBLE;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return H5T_NATIVE_INT32;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return H5T_NATIVE_INT64;
  else {
    static_assert(std::is_same_v<T, std::byte>, "float, double, 32- and 64-bit integers and bytes are stored");
    return H5T_NATIVE_UINT8;
  }
}

/// How a dataset is laid out in the file: contiguous, or in compressed chunks of so many rows.
struct Layout {
  hsize_t chunk_rows = 0;
  int gzip = 0;
};

/// An open file; objects are named by their path inside it, and missing groups are made on the way. Every member throws
/// std::runtime_error that names the file and the object.
class Hdf5File {
 public:
  static Hdf5File create(const std::filesystem::path& file);
  static Hdf5File open(const std::filesystem::path& file);

  void make_group(const std::string& path);
  template <class T>
  void write_attribute(const std::string& object, const std::string& name, std::span<const T> values) {
    write_attribute(object, name, hdf5_type<T>(), values.size(), values.data());
  }
  void write_attribute(const std::string& object, const std::string& name, const std::string& text);
  /// A dataset of `rows` x `columns` values (one-dimensional for one column), to be filled by `write_rows`.
  template <class T>
  Hdf5Handle make_dataset(const std::string& path, hsize_t rows, hsize_t columns = 1, Layout layout = {}) {
    return make_dataset(path, hdf5_type<T>(), rows, columns, layout);
  }
  template <class T>
  void write_rows(const Hdf5Handle& dataset, hsize_t first_row, hsize_t rows, const T* values) {
    write_rows(dataset, hdf5_type<T>(), first_row, rows, values);
  }
  template <class T>
  void write(const std::string& path, std::span<const T> values, hsize_t columns = 1, Layout layout = {}) {
    const hsize_t rows = values.size() / columns;
    const Hdf5Handle dataset = make_dataset<T>(path, rows, columns, layout);
    if (rows > 0) write_rows(dataset, 0, rows, values.data());
  }

  bool has(const std::string& path) const;
  bool has_attribute(const std::string& object, const std::string& name) const;
  template <class T>
  std::vector<T> read_attribute(const std::string& object, const std::string& name) const {
    const Hdf5Handle attribute = open_attribute(object, name);
    std::vector<T> values(attribute_size(attribute));
    check(H5Aread(attribute, hdf5_type<T>(), values.data()), "read attribute " + name);
    return values;
  }
  std::string read_text_attribute(const std::string& object, const std::string& name) const;
  std::size_t size(const std::string& path) const;  ///< number of values of a dataset
  /// Reads a whole dataset; `values` must have its size.
  template <class T>
  void read(const std::string& path, std::span<T> values) const {
    read(path, hdf5_type<T>(), values.size(), values.data());
  }
  template <class T>
  std::vector<T> read(const std::string& path) const {
    std::vector<T> values(size(path));
    read<T>(path, values);
    return values;
  }

  /// Writes what is left; to be called before the file counts as written.
  void close();

 private:
  Hdf5File(Hdf5Handle handle, std::string name) : handle_(std::move(handle)), name_(std::move(name)) {}

  [[noreturn]] void fail(const std::string& what) const;
  hid_t check(hid_t id, const std::string& what) const;
  Hdf5Handle open_object(const std::string& path) const;
  Hdf5Handle open_dataset(const std::string& path) const;
  void write_attribute(const std::string&, const std::string&, hid_t type, std::size_t count, const void* values);
  Hdf5Handle open_attribute(const std::string& object, const std::string& name) const;
  std::size_t attribute_size(const Hdf5Handle& attribute) const;
  Hdf5Handle make_dataset(const std::string& path, hid_t type, hsize_t rows, hsize_t columns, Layout layout);
  void write_rows(const Hdf5Handle& dataset, hid_t type, hsize_t first_row, hsize_t rows, const void* values);
  void read(const std::string& path, hid_t type, std::size_t count, void* values) const;

  Hdf5Handle handle_;
  std::string name_;
};

}  // namespace drogue::io
