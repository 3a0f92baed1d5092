// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/case_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/body_keys.hpp"
#include "app/body_reader.hpp"
#include "app/case_checks.hpp"
#include "app/measure_reader.hpp"
#include "app/section.hpp"
#include "app/value.hpp"
#include "core/error.hpp"

namespace drogue::app {

namespace {

namespace fs = std::filesystem;

const Choices<fluid::Boundary> boundaries{{"velocity", fluid::Boundary::velocity},
                                          {"outlet", fluid::Boundary::outlet},
                                          {"free_slip", fluid::Boundary::free_slip},
                                          {"no_slip", fluid::Boundary::no_slip},
                                          {"periodic", fluid::Boundary::periodic}};
const Choices<fluid::Collision> collisions{
    {"hrr", fluid::Collision::hrr}, {"rr", fluid::Collision::rr}, {"bgk", fluid::Collision::bgk}};
const Choices<fluid::EddyViscosity> eddy_models{{"none", fluid::EddyViscosity::none},
                                                {"vreman", fluid::EddyViscosity::vreman},
                                                {"wale", fluid::EddyViscosity::wale},
                                                {"smagorinsky", fluid::EddyViscosity::smagorinsky}};
const Choices<fluid::Storage> storages{{"half_stress", fluid::Storage::half_stress},
                                       {"float32", fluid::Storage::float32},
                                       {"float64", fluid::Storage::float64}};

fluid::Face read_face(Section face) {
  fluid::Face result;
  result.type = face.choose("type", boundaries, {.doc = "what happens at this side"});
  const bool all = face.describing();
  const Formulas rest{};
  if (all || result.type == fluid::Boundary::velocity) {
    result.velocity = face.get<Formulas>("velocity", {.unit = "m/s", .doc = "of the flow; for type = \"velocity\""});
    result.ramp = face.get<double>(
        "ramp",
        {.unit = "s", .doc = "time over which the velocity rises from zero", .fallback = 0.0, .range = not_negative});
  } else if (result.type == fluid::Boundary::no_slip) {
    result.velocity = face.get<Formulas>("velocity", {.unit = "m/s", .doc = "of the wall", .fallback = rest});
  }
  if (all || result.type == fluid::Boundary::velocity || result.type == fluid::Boundary::outlet) {
    result.reflecting =
        face.choose<bool>("sound", {{"leaves", false}, {"reflected", true}},
                          {.doc = "whether sound leaves, or comes back because velocity (the default of a velocity "
                                  "side) or pressure is held",
                           .fallback = result.type == fluid::Boundary::velocity ? "reflected" : "leaves"});
  }
  if (all || result.type == fluid::Boundary::outlet) {
    result.pressure = face.get<double>("pressure", {.unit = "Pa", .doc = "gauge, at an outlet", .fallback = 0.0});
    result.sponge = face.get<double>("sponge", {.unit = "m",
                                                .doc = "depth of the damping layer before an outlet; 0 for none",
                                                .fallback = 0.0,
                                                .range = not_negative});
  }
  return result;
}

void read_domain(Section domain, Case& c) {
  c.domain.box.lower = domain.get<Vec3>("lower", {.unit = "m", .doc = "corner with the smallest coordinates"});
  c.domain.box.upper = domain.get<Vec3>("upper", {.unit = "m", .doc = "corner with the largest coordinates"});
  for (int face = 0; face < 6; ++face) {
    c.fluid.face[face] = read_face(domain.section(face_names[face], "one of the six sides of the domain"));
  }
  for (int axis = 0; axis < 3; ++axis) {
    c.domain.periodic[axis] = c.fluid.face[2 * axis].type == fluid::Boundary::periodic;
  }
}

void read_initial_state(Section& section, Case& c) {
  const bool uniform =
      section.choose<bool>("initial", {{"uniform", true}, {"rest", false}},
                           {.doc = "start from initial_velocity, or from rest", .fallback = "uniform"});
  Formulas inflow{};
  for (const fluid::Face& face : c.fluid.face) {
    if (face.type == fluid::Boundary::velocity) {
      inflow = face.velocity;
      break;
    }
  }
  if (uniform || section.describing()) {
    c.fluid.initial_velocity = section.get<Formulas>(
        "initial_velocity", {.unit = "m/s",
                             .doc = "at t = 0, with initial = \"uniform\"; by default that of the first velocity side",
                             .derived = inflow});
  }
  c.fluid.initial_pressure =
      section.find<Expression>("initial_pressure", {.unit = "Pa", .doc = "gauge, at t = 0; zero if absent"});
}

double usual_constant(fluid::EddyViscosity model) {
  switch (model) {
    case fluid::EddyViscosity::none:
      return 0.0;
    case fluid::EddyViscosity::vreman:
      return 0.07;
    case fluid::EddyViscosity::wale:
      return 0.5;
    case fluid::EddyViscosity::smagorinsky:
      return 0.17;
  }
  return 0.0;
}

void read_collision(Section& section, fluid::Specification& fluid) {
  const bool all = section.describing();
  fluid.collision = section.choose("collision", collisions,
                                   {.doc = "hybrid recursive regularised, recursive regularised, or single relaxation "
                                           "time",
                                    .fallback = "hrr"});
  if (all || fluid.collision == fluid::Collision::hrr) {
    fluid.hrr_sigma = section.get<double>("hrr_sigma", {.doc = "share of the regularised stress; the rest is its "
                                                               "finite-difference estimate, which stabilises",
                                                        .fallback = 0.98,
                                                        .range = {.min = 0.0, .max = 1.0}});
    fluid.eddy_viscosity =
        section.choose("eddy_viscosity", eddy_models,
                       {.doc = "model of unresolved turbulence, with collision = \"hrr\"", .fallback = "none"});
  }
  if (all || fluid.eddy_viscosity != fluid::EddyViscosity::none) {
    fluid.eddy_constant =
        section.get<double>("eddy_constant", {.doc = "of the model; by default 0.07 (vreman), 0.5 (wale), 0.17 "
                                                     "(smagorinsky)",
                                              .derived = usual_constant(fluid.eddy_viscosity),
                                              .range = not_negative});
  }
  fluid.storage = section.choose(
      "storage", storages,
      {.doc = "of the state: float32 with the stress in 16 bits, all float32, all float64", .fallback = "half_stress"});
}

std::string read_solver(Section& fluid) {
  return fluid.choose<std::string>("solver", {{"lbm", "lbm"}, {"none", "none"}},
                                   {.doc = "lattice Boltzmann, or none for structures alone", .fallback = "lbm"});
}

void read_fluid(Section& section, Case& c) {
  fluid::Specification& fluid = c.fluid;
  fluid.density = section.get<double>("density", {.unit = "kg/m^3", .doc = "mass density", .range = positive});
  fluid.reference_velocity = section.get<double>(
      "reference_velocity",
      {.unit = "m/s", .doc = "of the drag coefficient, and what lattice_velocity stands for", .range = positive});
  const Key<double> length{.unit = "m", .doc = "of the Reynolds number; needed with fluid.reynolds", .range = positive};
  c.reference_length = section.has("reynolds") ? section.get<double>("reference_length", length)
                                               : section.find<double>("reference_length", length).value_or(0.0);
  const auto reynolds = section.find<double>(
      "reynolds", {.doc = "reference_velocity reference_length / viscosity, instead of viscosity", .range = positive});
  std::optional<double> viscosity;
  if (reynolds) viscosity = fluid.reference_velocity * c.reference_length / *reynolds;
  fluid.viscosity = section.get<double>(
      "viscosity",
      {.unit = "m^2/s", .doc = "kinematic; or give fluid.reynolds", .derived = viscosity, .range = positive});
  if (viscosity && std::abs(fluid.viscosity / *viscosity - 1.0) > 1e-6) {
    section.fail("viscosity", fmt::format("= {} contradicts fluid.reynolds = {}, which makes it {}; give one of them",
                                          fluid.viscosity, *reynolds, *viscosity));
  }
  fluid.lattice_velocity = section.get<double>(
      "lattice_velocity",
      {.doc =
           "cells that reference_velocity crosses in a time step; sets the step and the Mach number, sqrt(3) times it",
       .fallback = 0.05,
       .range = positive});
  fluid.force = read_formulas_of_time(
      section, "force", {.unit = "N/m^3", .doc = "on the whole fluid, formulas of t", .fallback = Formulas{}});
  read_collision(section, fluid);
  read_initial_state(section, c);
}

void read_grid(Section grid, Case& c) {
  c.domain.coarsest = grid.get<double>("coarsest", {.unit = "m", .doc = "cell edge of level 0", .range = positive});
  c.finest = grid.get<double>("finest", {.unit = "m", .doc = "smallest cell edge: coarsest / 2^n", .range = positive});
  grid.each("region", "where the grid is fine: a box, or around a body", [&](Section& region) {
    Region& r = c.regions.emplace_back();
    const bool all = region.describing();
    r.spacing = region.get<double>(
        "spacing",
        {.unit = "m", .doc = "cell edge there; by default grid.finest", .derived = c.finest, .range = positive});
    r.box = region.find<Box>("box", {.unit = "m", .doc = "the region, instead of body"});
    if (all || !r.box) {
      r.body = region.get<std::string>("body", {.doc = "name of the body the region surrounds, instead of box"});
      r.distance = region.get<double>("distance", {.unit = "m", .doc = "from the body", .range = positive});
      r.sweep = region.get<Vec3>(
          "sweep", {.unit = "m", .doc = "the way the body will move, included", .fallback = Vec3(0.0, 0.0, 0.0)});
    }
  });
}

fem::ContactOptions read_contact(Section section) {
  fem::ContactOptions contact;
  contact.gap =
      section.get<double>("gap", {.unit = "m",
                                  .doc = "within which surfaces push each other apart; no less than half an element",
                                  .range = positive});
  contact.stiffness = section.get<double>(
      "stiffness", {.doc = "squared frequency of two points in contact, over the largest of the elements",
                    .fallback = contact.stiffness,
                    .range = {.min = 0.0, .max = 1.0, .open = true}});
  contact.damping = section.get<double>(
      "damping",
      {.doc = "of that motion, over the critical one", .fallback = contact.damping, .range = {.min = 0.0, .max = 1.0}});
  return contact;
}

StructureSolver read_structure_solver(Section section, double end) {
  StructureSolver solver;
  const Choices<std::optional<fem::Equilibrium>> solvers{{"motion", std::nullopt},
                                                         {"equilibrium", fem::Equilibrium::cheaper},
                                                         {"relaxation", fem::Equilibrium::relaxation},
                                                         {"newton", fem::Equilibrium::newton}};
  const auto method = section.choose(
      "solver", solvers,
      {.doc = "motion, or equilibrium at the end of every step: by dynamic relaxation, Newton's method, or what is "
              "cheaper by estimate",
       .fallback = "motion"});
  solver.at_rest = method.has_value();
  solver.equilibrium.method = method.value_or(fem::Equilibrium::cheaper);
  solver.step = section.get<double>("step", {.unit = "s",
                                             .doc = "between states that can be written; by default a hundredth of "
                                                    "time.end, or all of it to an equilibrium",
                                             .derived = solver.at_rest ? end : end / 100.0,
                                             .range = positive});
  if (solver.at_rest || section.describing()) {
    solver.equilibrium.tolerance =
        section.get<double>("tolerance", {.doc = "forces left at rest, over loads and reactions",
                                          .fallback = solver.equilibrium.tolerance,
                                          .range = positive});
    solver.equilibrium.most_iterations = section.get<int>(
        "most_iterations",
        {.doc = "before it is given up", .fallback = solver.equilibrium.most_iterations, .range = {.min = 1}});
  }
  return solver;
}

void read_output(Section section, Case& c) {
  const auto interval = [&](const std::string& name, const std::string& doc, double fallback) {
    return section.get<double>(name, {.unit = "s", .doc = doc, .fallback = fallback, .range = not_negative});
  };
  c.output.history = interval("history", "between rows of history.csv; 0 for every coarse step", 0.0);
  c.output.fluid = interval("fluid", "between snapshots of the flow; 0 for none", 0.0);
  c.output.canopy = interval("canopy", "between snapshots of the bodies; 0 for none", 0.0);
  c.output.checkpoint = interval("checkpoint",
                                 "of wall time between checkpoints, from which `run --continue` goes on; also at the "
                                 "end and when interrupted; 0 for none",
                                 600.0);
}

void read_results(Section section, Case& c) {
  const std::string first = c.bodies.empty() ? "" : c.bodies.front().name;
  c.results.body =
      section.get<std::string>("body", {.doc = "whose results are summarised; by default the first", .derived = first});
  c.results.stable_window =
      section.get<Pair>("stable_window", {.unit = "s",
                                          .doc = "over which stable values are averaged; by default the second half",
                                          .derived = Pair{0.5 * c.end, c.end}});
  c.results.peak_from = section.get<double>("peak_from", {.unit = "s",
                                                          .doc = "peaks before it are not counted: an impulsive "
                                                                 "start is no peak",
                                                          .fallback = 0.0,
                                                          .range = not_negative});
}

void read_reference(const std::string& name, Section& section, Case& c) {
  Reference reference;
  reference.name = name;
  const auto below = section.find<double>(
      "below", {.doc = "bound on the magnitude of a result that should be zero, instead of value", .range = positive});
  if (!below || section.describing()) {
    reference.value = section.get<double>("value", {.doc = "published value of the result of this name, in SI"});
    reference.within = section.get<double>(
        "within", {.doc = "relative difference up to which they agree", .fallback = 0.1, .range = positive});
    if (reference.value == 0.0) {
      section.fail("value", "= 0; a relative difference from zero says nothing, so give a bound: below");
    }
  }
  if (below) reference.within = *below;
  reference.source = section.get<std::string>("source", {.doc = "where it is published", .fallback = ""});
  c.references.push_back(reference);
}

Case read_all(const Document& document, Record& record) {
  Case c;
  Section root(document, record);
  c.title = root.get<std::string>("title", {.doc = "one line on what the case is", .fallback = ""});
  if (root.describing()) root.find<std::string>("base", {.doc = "another case file that this one completes"});
  Section fluid = root.section("fluid", "the fluid and its solver");
  c.solver = read_solver(fluid);
  if (c.has_fluid()) {
    read_domain(root.section("domain", "the box of fluid"), c);
    read_fluid(fluid, c);
    read_grid(root.section("grid", "the block-refined grid"), c);
  }
  root.each("body", "a body, in the flow if there is one",
            [&](Section& body) { c.bodies.push_back(read_body(body, c)); });
  if (root.has("contact") || root.describing()) {
    c.contact =
        read_contact(root.section("contact", "of the elastic bodies' surfaces, with each other and themselves"));
  }
  Section time = root.section("time", "the run");
  c.end = time.get<double>("end", {.unit = "s", .doc = "the run starts at 0", .range = positive});
  if (!c.has_fluid() || root.describing()) {
    c.structure = read_structure_solver(root.section("structure", "how structures move without a fluid"), c.end);
  }
  if (c.has_fluid()) {
    c.measure = read_measure(root.section("measure", "what is measured of the flow, beyond what every run tells"));
  }
  read_output(root.section("output", "what is written, and when"), c);
  read_results(root.section("results", "what is summarised at the end"), c);
  root.section("reference", "published results")
      .each_named("one published number, named like the result it is compared with",
                  [&](const std::string& name, Section& section) { read_reference(name, section, c); });
  return c;
}

fs::path case_file(const fs::path& path) {
  if (fs::is_directory(path)) {
    const fs::path file = path / "case.toml";
    if (!fs::exists(file)) throw InputError(fmt::format("{} holds no case.toml", path.string()));
    return file;
  }
  if (!fs::exists(path)) throw InputError(fmt::format("{} does not exist; expected a case folder", path.string()));
  return path;
}

}  // namespace

Record describe_case() {
  Record record;
  record.describing = true;
  read_all({}, record);
  return record;
}

Case read_case(const fs::path& path, const std::vector<std::string>& overrides) {
  const Record schema = describe_case();
  const Document document = load_document(case_file(path).lexically_normal(), overrides);
  refuse_unknown_keys(document, schema);
  Record record;
  Case c = read_all(document, record);
  refuse_unread_keys(document, record, schema);
  c.file = document.file;
  c.name = fs::absolute(document.file).parent_path().filename();
  c.origin = record.origin;
  c.resolved = to_toml(record);
  check_case(c);
  return c;
}

}  // namespace drogue::app
