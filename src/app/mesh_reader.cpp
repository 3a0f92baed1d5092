// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/mesh_reader.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "app/case_checks.hpp"
#include "app/value.hpp"
#include "core/error.hpp"
#include "core/process.hpp"

namespace drogue::app {

namespace {

namespace fs = std::filesystem;

constexpr const char* elements_doc =
    "along the two edges (and through the thickness, of a plate or block); of a disk: across the square in its middle, "
    "and layers around it";
const Range whole_positive{.min = 1, .max = 100000};
constexpr double most_elements = 1e7;

void expect_at_most(Section& mesh, double elements) {
  if (elements <= most_elements) return;
  mesh.fail("elements", fmt::format("makes {:.3g} elements; expected at most {:.0e}", elements, most_elements));
}

fs::path read_mesh_file(Section& body) {
  const fs::path file = body.get<fs::path>(
      "mesh", {.doc = "mesh of an elastic body, of hexahedra, quadrangles, triangles, lines: .msh (gmsh 4.1), .geo, or "
                      "a table"});
  if (!fs::is_regular_file(file)) body.fail("mesh", fmt::format("= \"{}\" does not exist", file.string()));
  if (file.extension() != ".msh" && file.extension() != ".geo") {
    body.fail("mesh", fmt::format("= \"{}\" is no mesh; expected a file .msh or .geo", file.string()));
  }
  return file;
}

MeshDescription read_plate(Section& mesh) {
  fem::PlateDescription plate;
  plate.centre = mesh.get<Vec3>("centre", {.unit = "m", .doc = "of the mid-surface of a plate, or of a disk"});
  plate.normal = mesh.choose("normal", axes, {.doc = "axis the plate or disk is thin in"});
  plate.size = mesh.get<Pair>(
      "size", {.unit = "m", .doc = "edges, along the axes that follow the normal cyclically", .range = positive});
  plate.thickness = mesh.get<double>("thickness", {.unit = "m", .doc = "along the normal", .range = positive});
  plate.elements = mesh.get<Index3>("elements", {.doc = elements_doc, .range = whole_positive});
  expect_at_most(mesh, 1.0 * plate.elements[0] * plate.elements[1] * plate.elements[2]);
  return plate;
}

bool read_triangles(Section& mesh) {
  return mesh.get<bool>("triangles", {.doc = "of a sheet or disk, instead of quadrilaterals", .fallback = false});
}

Corners read_corners(Section& mesh) {
  return mesh.get<Corners>("corners", {.unit = "m", .doc = "of a sheet, or of the base of a block, in order around"});
}

MeshDescription read_sheet(Section& mesh) {
  fem::SheetDescription sheet;
  sheet.corner = read_corners(mesh);
  sheet.elements = mesh.get<Index2>("elements", {.doc = elements_doc, .range = whole_positive});
  expect_at_most(mesh, 1.0 * sheet.elements[0] * sheet.elements[1]);
  sheet.triangles = read_triangles(mesh);
  return sheet;
}

MeshDescription read_disk(Section& mesh) {
  fem::DiskDescription disk;
  disk.centre = mesh.get<Vec3>("centre", {.unit = "m", .doc = "of the mid-surface of a plate, or of a disk"});
  disk.normal = mesh.choose("normal", axes, {.doc = "axis the plate or disk is thin in"});
  disk.radius = mesh.get<double>("radius", {.unit = "m", .doc = "of a disk", .range = positive});
  disk.elements = mesh.get<Index2>("elements", {.doc = elements_doc, .range = whole_positive});
  expect_at_most(mesh, disk.elements[0] * (disk.elements[0] + 4.0 * disk.elements[1]));
  disk.triangles = read_triangles(mesh);
  return disk;
}

MeshDescription read_block(Section& mesh) {
  BlockDescription block;
  block.base.corner = read_corners(mesh);
  block.way = mesh.get<Vec3>("way", {.unit = "m", .doc = "that the base of a block sweeps, towards its normal"});
  const Index3 elements = mesh.get<Index3>("elements", {.doc = elements_doc, .range = whole_positive});
  expect_at_most(mesh, 1.0 * elements[0] * elements[1] * elements[2]);
  block.base.elements = {elements[0], elements[1]};
  block.layers = elements[2];
  return block;
}

fs::path generate_mesh(const Case& c, const std::string& key, const Body& body, const fs::path& geometry,
                       const fs::path& folder) {
  fs::create_directories(folder);
  const fs::path mesh = folder / fmt::format("{}.msh", body.name), log = folder / fmt::format("{}.gmsh.log", body.name);
  const int status = run_program({"gmsh", "-3", "-format", "msh41", "-o", mesh.string(), geometry.string()}, log);
  if (status == not_installed) {
    fail(
        c, key,
        fmt::format("= \"{}\" needs gmsh, which is not installed; on Debian: apt-get install gmsh", geometry.string()));
  }
  if (status != 0 || !fs::exists(mesh)) {
    fail(c, key, fmt::format("= \"{}\" could not be meshed by gmsh; see {}", geometry.string(), log.string()));
  }
  return mesh;
}

void add_cable(fem::Mesh& mesh, const CableDescription& cable) {
  const std::vector<int> from = nodes_named(mesh, cable.from), to = nodes_named(mesh, cable.to);
  for (const int start : from) {
    const auto distance = [&](int node) { return (mesh.nodes[node] - mesh.nodes[start]).squaredNorm(); };
    const int end = *std::ranges::min_element(to, {}, distance);
    if (distance(end) == 0.0) throw InputError("it joins a node with itself, or with one at the same place");
    add_line(mesh, cable.name, start, end, cable.elements);
  }
}

}  // namespace

MeshDescription read_mesh_description(Section& body) {
  const bool is_file = !body.has_table("mesh");
  MeshDescription mesh;
  if (is_file || body.describing()) mesh = read_mesh_file(body);
  if (is_file && !body.describing()) return mesh;
  Section section = body.section("mesh", "a generated mesh, instead of a file");
  using Read = MeshDescription (*)(Section&);
  const Choices<Read> types{{"plate", read_plate},
                            {"block", read_block},
                            {"sheet", read_sheet},
                            {"disk", read_disk},
                            {"empty", [](Section&) -> MeshDescription { return fem::Mesh{}; }}};
  const Read read = section.choose("type", types,
                                   {.doc = "solid plate or block, flat sheet or disk of membrane elements, or nothing "
                                           "but the body's points and cables"});
  if (!section.describing()) return read(section);
  for (const auto& type : types) type.second(section);
  return mesh;
}

std::optional<double> area_of(const MeshDescription& mesh) {
  if (const auto* plate = std::get_if<fem::PlateDescription>(&mesh)) return plate->size[0] * plate->size[1];
  if (const auto* disk = std::get_if<fem::DiskDescription>(&mesh))
    return std::numbers::pi * disk->radius * disk->radius;
  if (const auto* sheet = std::get_if<fem::SheetDescription>(&mesh)) {
    const auto& c = sheet->corner;
    return 0.5 * (c[2] - c[0]).cross(c[3] - c[1]).norm();
  }
  return std::nullopt;
}

fem::Mesh load_mesh(const Case& c, const Body& body, const fs::path& folder) {
  const auto& elastic = std::get<ElasticBody>(body.kind);
  const std::string key = "body." + body.name;
  struct Maker {
    const Case& c;
    const Body& body;
    const fs::path& folder;

    fem::Mesh operator()(const fem::PlateDescription& plate) const { return make_plate(plate); }
    fem::Mesh operator()(const fem::SheetDescription& sheet) const { return make_sheet(sheet); }
    fem::Mesh operator()(const fem::DiskDescription& disk) const { return make_disk(disk); }
    fem::Mesh operator()(const BlockDescription& block) const {
      return extruded(make_sheet(block.base), block.way, block.layers);
    }
    fem::Mesh operator()(const fem::Mesh& mesh) const { return mesh; }
    fem::Mesh operator()(const fs::path& file) const {
      if (file.extension() != ".geo") return fem::read_msh(file);
      return fem::read_msh(generate_mesh(c, fmt::format("body.{}.mesh", body.name), body, file, folder));
    }
  };
  fem::Mesh mesh = std::visit(Maker{c, body, folder}, elastic.mesh);
  for (const PointDescription& point : elastic.points) add_point(mesh, point.name, point.place);
  for (const CableDescription& cable : elastic.cables) {
    at_key(c, fmt::format("{}.cable.{}", key, cable.name), [&] { add_cable(mesh, cable); });
  }
  return mesh;
}

}  // namespace drogue::app
