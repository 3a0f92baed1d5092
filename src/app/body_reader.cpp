// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/body_reader.hpp"

#include <fmt/format.h>

#include "app/shape_reader.hpp"
#include "app/value.hpp"

namespace drogue::app {

namespace {

namespace fs = std::filesystem;

const Choices<fsi::Scheme> schemes{{"added_mass", fsi::Scheme::added_mass}, {"peskin", fsi::Scheme::peskin}};
const Choices<ib::Delta> deltas{{"peskin4", ib::Delta::peskin4}, {"peskin3", ib::Delta::peskin3}};
constexpr const char* coupling_doc = "between body and fluid";

std::string read_name(Section& body) {
  return body.get<std::string>("name", {.doc = "for keys, messages and columns"});
}

double read_reference_area(Section& body, const std::optional<double>& area) {
  return body.get<double>("reference_area", {.unit = "m^2",
                                             .doc = "of the drag coefficient; by default that of a plate or a shape",
                                             .derived = area,
                                             .range = positive});
}

ib::Delta read_delta(Section& coupling) {
  return coupling.choose("delta", deltas, {.doc = "regularised delta function", .fallback = "peskin4"});
}

fem::PlateDescription read_plate(Section mesh) {
  fem::PlateDescription plate;
  mesh.choose<int>("type", {{"plate", 0}}, {.doc = "shape of a generated mesh"});
  plate.centre = mesh.get<Vec3>("centre", {.unit = "m", .doc = "of the mid-surface"});
  plate.normal = mesh.choose("normal", axes, {.doc = "axis the plate is thin in"});
  plate.size = mesh.get<Pair>(
      "size", {.unit = "m", .doc = "edges, along the axes that follow the normal cyclically", .range = positive});
  plate.thickness = mesh.get<double>("thickness", {.unit = "m", .doc = "along the normal", .range = positive});
  plate.elements = mesh.get<Index3>(
      "elements", {.doc = "along the two edges and through the thickness", .range = {.min = 1, .max = 100000}});
  return plate;
}

fs::path read_mesh_file(Section& body) {
  const fs::path file =
      body.get<fs::path>("mesh", {.doc = "mesh of hexahedra of an elastic body: .msh (gmsh 4.1), .geo, or a table"});
  if (!fs::is_regular_file(file)) body.fail("mesh", fmt::format("= \"{}\" does not exist", file.string()));
  if (file.extension() != ".msh" && file.extension() != ".geo") {
    body.fail("mesh", fmt::format("= \"{}\" is no mesh; expected a file .msh or .geo", file.string()));
  }
  return file;
}

std::variant<fem::PlateDescription, fs::path> read_mesh(Section& body) {
  const bool is_file = !body.has_table("mesh");
  fs::path file;
  if (is_file || body.describing()) file = read_mesh_file(body);
  if (is_file && !body.describing()) return file;
  return read_plate(body.section("mesh", "a generated mesh, instead of a file"));
}

fem::Material read_material(Section section) {
  const bool neo_hookean = section.choose<bool>("law", {{"neo_hookean", true}, {"saint_venant_kirchhoff", false}},
                                                {.doc = "hyperelastic law"});
  const Range ratio{.min = -1.0, .max = 0.5, .open = true};
  const double young = section.get<double>("young", {.unit = "Pa", .doc = "Young's modulus", .range = positive});
  const double poisson = section.get<double>("poisson", {.doc = "Poisson's ratio", .range = ratio});
  double stabilisation = poisson;
  if (neo_hookean || section.describing()) {
    stabilisation = section.get<double>(
        "poisson_stabilisation",
        {.doc = "ratio behind the bulk modulus, for law = \"neo_hookean\"; by default that of poisson",
         .derived = poisson,
         .range = ratio});
  }
  if (section.describing()) return fem::SaintVenantKirchhoff(1.0, 0.0);
  if (neo_hookean) return fem::NeoHookean(young, poisson, stabilisation);
  return fem::SaintVenantKirchhoff(young, poisson);
}

HoldDescription read_hold(Section& section) {
  HoldDescription hold;
  const bool all = section.describing();
  hold.nodes =
      section.get<std::string>("nodes", {.doc = "\"corners\", \"all\", or the name of a node set of the mesh"});
  if (all || hold.nodes == "corners") {
    hold.patch = section.get<double>("patch", {.unit = "m",
                                               .doc = "edge of the held corner, for nodes = \"corners\"; 0 holds the "
                                                      "corner nodes alone",
                                               .fallback = 0.0,
                                               .range = not_negative});
  }
  hold.rigid = section.get<bool>("rigid", {.doc = "hold in place instead of by a tether", .fallback = false});
  if (all || !hold.rigid) {
    hold.stiffness = section.get<double>(
        "stiffness", {.unit = "N/m^4", .doc = "of the tether, per displacement and volume", .range = positive});
    hold.damping = section.get<double>(
        "damping",
        {.unit = "N s/m^4", .doc = "of the tether, per velocity and volume", .fallback = 0.0, .range = not_negative});
  }
  return hold;
}

fem::StructureOptions read_structure(Section& body) {
  fem::StructureOptions options;
  options.density = body.get<double>("density", {.unit = "kg/m^3", .doc = "own mass", .range = positive});
  options.dissipation = body.get<double>("dissipation", {.doc = "numerical, of what the sub-step barely resolves",
                                                         .fallback = options.dissipation,
                                                         .range = {.min = 0.0, .max = 0.49}});
  options.safety = body.get<double>("safety", {.doc = "share of the stable sub-step that is used",
                                               .fallback = options.safety,
                                               .range = {.min = 0.01, .max = 1.0}});
  options.volume_ratio = body.get<Pair>(
      "volume_ratio",
      {.doc = "bounds of J; an element beyond them ends the run", .fallback = options.volume_ratio, .range = positive});
  return options;
}

fsi::CouplingOptions read_elastic_coupling(Section coupling) {
  fsi::CouplingOptions options;
  options.scheme = coupling.choose("scheme", schemes, {.doc = "how body and fluid meet", .fallback = "added_mass"});
  options.delta = read_delta(coupling);
  return options;
}

Body read_elastic(Section& section, const Case& c) {
  const std::string name = read_name(section);
  const auto mesh = read_mesh(section);
  const fem::StructureOptions structure = read_structure(section);
  std::optional<double> area;
  if (const auto* plate = std::get_if<fem::PlateDescription>(&mesh)) area = plate->size[0] * plate->size[1];
  const double reference_area = read_reference_area(section, area);
  ElasticBody body{.mesh = mesh,
                   .material = read_material(section.section("material", "what the body is made of")),
                   .structure = structure,
                   .holds = {},
                   .coupling = read_elastic_coupling(section.section("coupling", coupling_doc))};
  section.each("hold", "nodes that are held near where they start",
               [&](Section& hold) { body.holds.push_back(read_hold(hold)); });
  body.coupling.fluid_density = c.fluid.density;
  body.coupling.body = name;
  return {name, reference_area, std::move(body)};
}

geometry::Shape read_surface(Section& body) {
  const fs::path file =
      body.get<fs::path>("surface", {.doc = "of a rigid body: .stl, or the triangles and quadrangles of a .msh"});
  if (body.describing()) return {};
  if (!fs::is_regular_file(file)) body.fail("surface", fmt::format("= \"{}\" does not exist", file.string()));
  if (file.extension() != ".stl" && file.extension() != ".msh") {
    body.fail("surface", fmt::format("= \"{}\" is no surface; expected a file .stl or .msh", file.string()));
  }
  return geometry::triangulated(file);
}

void expect_time_alone(const Section& section, const std::string& name, const Expression& formula) {
  if (!formula.depends_on_place()) return;
  section.fail(name, fmt::format("= \"{}\" depends on the place; expected a formula in t alone", formula.text()));
}

ib::RigidMotion read_motion(Section section, const Vec3& centre) {
  ib::RigidMotion motion;
  motion.translation = section.get<Formulas>(
      "translation", {.unit = "m", .doc = "of a rigid body from where it is described", .fallback = Formulas{}});
  for (const Expression& formula : motion.translation) expect_time_alone(section, "translation", formula);
  Section rotation = section.section("rotation", "of a rigid body about a fixed direction");
  const Vec3 axis =
      rotation.get<Vec3>("axis", {.doc = "direction about which it turns, right-handed", .fallback = Vec3::UnitZ()});
  if (axis.norm() == 0.0) rotation.fail("axis", "= [0, 0, 0] is no direction");
  motion.axis = axis.normalized();
  motion.pivot = rotation.get<Vec3>(
      "centre", {.unit = "m", .doc = "moves with the translation; by default the body's", .derived = centre});
  motion.angle = rotation.get<Expression>("angle", {.unit = "rad", .doc = "in time", .fallback = Expression(0.0)});
  expect_time_alone(rotation, "angle", motion.angle);
  return motion;
}

ib::RigidBodyOptions read_rigid_coupling(Section coupling, const Case& c, bool encloses_volume) {
  ib::RigidBodyOptions options;
  options.delta = read_delta(coupling);
  options.iterations = coupling.get<int>("iterations", {.doc = "passes of direct forcing a step, of a rigid body",
                                                        .fallback = options.iterations,
                                                        .range = {.min = 1, .max = 100}});
  options.spacing = coupling.get<double>("spacing", {.doc = "of a rigid body's markers, in finest cells",
                                                     .fallback = options.spacing,
                                                     .range = {.min = 0.25, .max = 2}});
  if (encloses_volume || coupling.describing()) {
    options.retraction = coupling.get<double>(
        "retraction",
        {.doc = "of a closed rigid body's markers, in finest cells; by default so far that the fluid sees "
                "the surface where it is",
         .derived = wall_offset(c, options.delta),
         .range = {.min = 0.0, .max = 2.0}});
  }
  return options;
}

Body read_rigid(Section& section, const Case& c) {
  const std::string name = read_name(section);
  RigidBody body;
  body.key = section.has("surface") ? "surface" : "shape";
  if (body.key == "surface" || section.describing()) body.shape = read_surface(section);
  if (body.key == "shape") body.shape = read_shape(section.section("shape", "of a rigid body, by its dimensions"));
  const double suggested = body.shape.reference_area;
  const double reference_area = read_reference_area(section, suggested > 0.0 ? std::optional(suggested) : std::nullopt);
  body.motion = read_motion(section.section("motion", "of a rigid body, prescribed"), body.shape.centre);
  body.coupling = read_rigid_coupling(section.section("coupling", coupling_doc), c, body.shape.encloses_volume);
  body.coupling.fluid_density = c.fluid.density;
  body.coupling.body = name;
  return {name, reference_area, std::move(body)};
}

}  // namespace

Body read_body(Section& section, const Case& c) {
  const bool rigid = section.has("shape") || section.has("surface");
  if (!rigid || section.describing()) {
    Body body = read_elastic(section, c);
    if (!section.describing()) return body;
  }
  return read_rigid(section, c);
}

}  // namespace drogue::app
