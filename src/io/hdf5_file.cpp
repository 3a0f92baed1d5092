// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/hdf5_file.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

namespace drogue::io {

Hdf5Handle& Hdf5Handle::operator=(Hdf5Handle&& other) noexcept {
  close();
  id_ = std::exchange(other.id_, H5I_INVALID_HID);
  closer_ = other.closer_;
  return *this;
}

bool Hdf5Handle::close() {
  const hid_t id = std::exchange(id_, H5I_INVALID_HID);
  return id < 0 || closer_(id) >= 0;
}

namespace {
// Failures are reported by exceptions, so the library's own printing is switched off; and its clean-up at exit too,
// which crashes on a file that could not be closed because the disk is full.
void quieten_library() {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}
}  // namespace

Hdf5File Hdf5File::create(const std::filesystem::path& file) {
  quieten_library();
  Hdf5File result({H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose}, file.string());
  result.check(result.handle_, "create it");
  return result;
}

Hdf5File Hdf5File::open(const std::filesystem::path& file) {
  quieten_library();
  Hdf5File result({H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose}, file.string());
  result.check(result.handle_, "open it");
  return result;
}

void Hdf5File::fail(const std::string& what) const {
  throw std::runtime_error(fmt::format("{}: HDF5 could not {}", name_, what));
}

hid_t Hdf5File::check(hid_t id, const std::string& what) const {
  if (id < 0) fail(what);
  return id;
}

void Hdf5File::make_group(const std::string& path) {
  const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  check(H5Pset_create_intermediate_group(links, 1), "make group " + path);
  const Hdf5Handle group(H5Gcreate2(handle_, path.c_str(), links, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  check(group, "make group " + path);
}

Hdf5Handle Hdf5File::open_object(const std::string& path) const {
  Hdf5Handle object(H5Oopen(handle_, path.c_str(), H5P_DEFAULT), H5Oclose);
  check(object, "open " + path);
  return object;
}

Hdf5Handle Hdf5File::open_dataset(const std::string& path) const {
  Hdf5Handle dataset(H5Dopen2(handle_, path.c_str(), H5P_DEFAULT), H5Dclose);
  check(dataset, "open dataset " + path);
  return dataset;
}

Hdf5Handle Hdf5File::open_attribute(const std::string& object, const std::string& name) const {
  Hdf5Handle attribute(H5Aopen_by_name(handle_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(attribute, fmt::format("open attribute {} of {}", name, object));
  return attribute;
}

void Hdf5File::write_attribute(const std::string& object, const std::string& name, hid_t type, std::size_t count,
                               const void* values) {
  const hsize_t dimension = count;
  const Hdf5Handle owner = open_object(object), space(H5Screate_simple(1, &dimension, nullptr), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(attribute, "make attribute " + name);
  check(H5Awrite(attribute, type, values), "write attribute " + name);
}

// A scalar of fixed length in ASCII: the only kind of string VTK's reader accepts.
void Hdf5File::write_attribute(const std::string& object, const std::string& name, const std::string& text) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  check(H5Tset_size(type, std::max<std::size_t>(text.size(), 1)), "write attribute " + name);
  check(H5Tset_strpad(type, H5T_STR_NULLPAD), "write attribute " + name);
  const Hdf5Handle owner = open_object(object);
  const Hdf5Handle attribute(H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(attribute, "make attribute " + name);
  check(H5Awrite(attribute, type, text.c_str()), "write attribute " + name);
}

std::string Hdf5File::read_text_attribute(const std::string& object, const std::string& name) const {
  const Hdf5Handle attribute = open_attribute(object, name), type(H5Aget_type(attribute), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) fail("read text attribute " + name);
  std::string text(H5Tget_size(type), '\0');
  check(H5Aread(attribute, type, text.data()), "read attribute " + name);
  return text.substr(0, text.find('\0'));
}

std::size_t Hdf5File::attribute_size(const Hdf5Handle& attribute) const {
  const Hdf5Handle space(H5Aget_space(attribute), H5Sclose);
  return static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space), "size an attribute"));
}

Hdf5Handle Hdf5File::make_dataset(const std::string& path, hid_t type, hsize_t rows, hsize_t columns, Layout layout) {
  const std::array<hsize_t, 2> extent{rows, columns};
  const int rank = columns > 1 ? 2 : 1;
  const Hdf5Handle space(H5Screate_simple(rank, extent.data(), nullptr), H5Sclose);
  const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose), options(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  check(H5Pset_create_intermediate_group(links, 1), "make dataset " + path);
  check(H5Pset_obj_track_times(options, false), "make dataset " + path);  // the same bytes on another day
  if (layout.chunk_rows > 0) {
    const std::array<hsize_t, 2> chunk{layout.chunk_rows, columns};
    check(H5Pset_chunk(options, rank, chunk.data()), "chunk dataset " + path);
    if (layout.gzip > 0) {
      check(H5Pset_shuffle(options), "compress dataset " + path);
      check(H5Pset_deflate(options, static_cast<unsigned>(layout.gzip)), "compress dataset " + path);
    }
  }
  Hdf5Handle dataset(H5Dcreate2(handle_, path.c_str(), type, space, links, options, H5P_DEFAULT), H5Dclose);
  check(dataset, "make dataset " + path);
  return dataset;
}

void Hdf5File::write_rows(const Hdf5Handle& dataset, hid_t type, hsize_t first_row, hsize_t rows, const void* values) {
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  std::array<hsize_t, 2> start{first_row, 0}, count{};
  const int rank = check(H5Sget_simple_extent_dims(space, count.data(), nullptr), "size a dataset");
  count[0] = rows;
  const Hdf5Handle memory(H5Screate_simple(rank, count.data(), nullptr), H5Sclose);
  check(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), "select rows");
  check(H5Dwrite(dataset, type, memory, space, H5P_DEFAULT, values), "write data");
}

bool Hdf5File::has(const std::string& path) const {
  for (std::size_t slash = path.find('/', 1);;
       slash = path.find('/', slash + 1)) {  // every group on the way must exist
    if (H5Lexists(handle_, path.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
    if (slash == std::string::npos) return true;
  }
}

bool Hdf5File::has_attribute(const std::string& object, const std::string& name) const {
  return H5Aexists_by_name(handle_, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::size_t Hdf5File::size(const std::string& path) const {
  const Hdf5Handle dataset = open_dataset(path), space(H5Dget_space(dataset), H5Sclose);
  return static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space), "size " + path));
}

void Hdf5File::read(const std::string& path, hid_t type, std::size_t count, void* values) const {
  const Hdf5Handle dataset = open_dataset(path);
  if (size(path) != count) fail(fmt::format("read {}: it has {} values, not {}", path, size(path), count));
  if (count > 0) check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "read " + path);
}

void Hdf5File::close() {
  if (H5Fflush(handle_, H5F_SCOPE_LOCAL) < 0 || !handle_.close()) fail("write it to the end (is the disk full?)");
}

}  // namespace drogue::io
