// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/body_reader.hpp"

#include <fmt/format.h>

#include "app/body_keys.hpp"
#include "app/elastic_reader.hpp"
#include "app/shape_reader.hpp"

namespace drogue::app {

namespace {

namespace fs = std::filesystem;

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

ib::RigidMotion read_motion(Section section, const Vec3& centre) {
  ib::RigidMotion motion;
  motion.translation =
      read_formulas_of_time(section, "translation",
                            {.unit = "m", .doc = "of a rigid body from where it is described", .fallback = Formulas{}});
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
  if (!c.has_fluid() && !section.describing()) {
    section.fail(section.has("shape") ? "shape" : "surface",
                 "makes the body rigid, but there is no fluid it could move "
                 "in; expected a body with a mesh");
  }
  return read_rigid(section, c);
}

}  // namespace drogue::app
