// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/canopy.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <string_view>

#include "io/pending_file.hpp"

namespace drogue::io {
namespace {

/// VTK's number of the cell that so many points make.
template <std::size_t N>
constexpr std::uint8_t vtk_cell = N == 8   ? 12
                                  : N == 4 ? 9
                                  : N == 3 ? 5
                                           : 3;

template <class T>
constexpr std::string_view vtk_type = "";
template <>
constexpr std::string_view vtk_type<double> = "Float64";
template <>
constexpr std::string_view vtk_type<std::int32_t> = "Int32";
template <>
constexpr std::string_view vtk_type<std::uint8_t> = "UInt8";

/// The XML that describes the arrays, and the raw bytes behind it: each array preceded by its length as UInt64.
class AppendedArrays {
 public:
  template <class T>
  std::string add(std::string_view name, int components, std::span<const T> values, std::string_view extra = "") {
    const std::string element =
        fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}"{} format="appended" offset="{}"/>)",
                    vtk_type<T>, name, components, extra, bytes_.size());
    const std::uint64_t length = values.size_bytes();
    append(&length, sizeof length);
    append(values.data(), length);
    return element;
  }
  std::string add(std::string_view name, std::span<const Vec3> vectors) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    return add(name, 3,
               std::span<const double>(vectors.empty() ? nullptr : vectors.front().data(), 3 * vectors.size()));
  }
  std::string_view bytes() const { return bytes_; }

 private:
  void append(const void* data, std::size_t length) { bytes_.append(static_cast<const char*>(data), length); }
  std::string bytes_;
};

std::string escaped(std::string_view name) {
  std::string text;
  for (char c : name) {
    if (c == '&')
      text += "&amp;";
    else if (c == '<')
      text += "&lt;";
    else if (c == '"')
      text += "&quot;";
    else
      text += c;
  }
  return text;
}

void check_length(std::size_t length, std::size_t expected, std::string_view what) {
  if (length != expected) throw std::invalid_argument(fmt::format("{} values of {} for {}", length, what, expected));
}

using Arrays = std::map<std::string, std::span<const Vec3>>;

/// Cells as VTK lists them.
struct CellList {
  std::vector<std::int32_t> connectivity, offsets;
  std::vector<std::uint8_t> types;

  template <std::size_t N>
  void add(const std::vector<std::array<int, N>>& cells) {
    for (const auto& cell : cells) {
      connectivity.insert(connectivity.end(), cell.begin(), cell.end());
      offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
      types.push_back(vtk_cell<N>);
    }
  }
};

/// Cells with point data and cell data.
void write(const std::filesystem::path& file, const CellList& cells, std::span<const Vec3> position,
           const Arrays& point_data, const std::map<std::string, std::vector<double>>& cell_data,
           std::optional<double> time) {
  AppendedArrays arrays;
  std::string xml =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<UnstructuredGrid>\n";
  if (time) {
    const std::span<const double> value(&*time, 1);
    xml += fmt::format("<FieldData>{}</FieldData>\n", arrays.add("TimeValue", 1, value, " NumberOfTuples=\"1\""));
  }
  xml += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", position.size(), cells.types.size());
  xml += fmt::format("<Points>{}</Points>\n", arrays.add("Points", position));
  xml += "<Cells>" + arrays.add<std::int32_t>("connectivity", 1, cells.connectivity);
  xml += arrays.add<std::int32_t>("offsets", 1, cells.offsets) + arrays.add<std::uint8_t>("types", 1, cells.types) +
         "</Cells>\n";
  xml += "<PointData Vectors=\"Displacement\">";
  for (const auto& [name, vectors] : point_data) {
    check_length(vectors.size(), position.size(), name);
    xml += arrays.add(name, vectors);
  }
  xml += "</PointData>\n<CellData>";
  for (const auto& [name, values] : cell_data) {
    check_length(values.size(), cells.types.size(), name);
    xml += arrays.add<double>(escaped(name), 1, values);
  }
  xml += "</CellData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";

  PendingStream stream(file);
  stream.write(xml);
  stream.write(arrays.bytes());
  stream.write("\n</AppendedData>\n</VTKFile>\n");
  stream.commit();
}

std::vector<Vec3> difference(std::span<const Vec3> now, std::span<const Vec3> before) {
  check_length(now.size(), before.size(), "position");
  std::vector<Vec3> vectors(now.size());
  for (std::size_t n = 0; n < now.size(); ++n) vectors[n] = now[n] - before[n];
  return vectors;
}

}  // namespace

void write_canopy(const std::filesystem::path& file, const fem::Mesh& mesh, std::span<const Vec3> position,
                  std::span<const Vec3> velocity, const std::map<std::string, std::vector<double>>& cell_data,
                  std::optional<double> time) {
  const std::vector<Vec3> displacement = difference(position, mesh.nodes);
  CellList cells;
  cells.add(mesh.hexahedra);
  cells.add(mesh.quadrilaterals);
  cells.add(mesh.triangles);
  cells.add(mesh.lines);
  write(file, cells, position, {{"Displacement", displacement}, {"Velocity", velocity}}, cell_data, time);
}

void write_surface(const std::filesystem::path& file, const geometry::TriangleMesh& mesh,
                   std::span<const Vec3> position, double time) {
  const std::vector<Vec3> displacement = difference(position, mesh.points);
  CellList cells;
  cells.add(mesh.triangles);
  write(file, cells, position, {{"Displacement", displacement}}, {}, time);
}

}  // namespace drogue::io
