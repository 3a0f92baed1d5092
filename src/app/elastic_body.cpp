// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/elastic_body.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "app/case_checks.hpp"
#include "io/canopy.hpp"

namespace drogue::app {

namespace {

const ElasticBody& elastic(const Body& body) { return std::get<ElasticBody>(body.kind); }

std::vector<int> find_nodes(const Case& c, const std::string& key, const NodesNamed& nodes, const fem::Mesh& mesh) {
  std::vector<int> found;
  at_key(c, key, [&] { found = nodes_named(mesh, nodes.name, nodes.patch); });
  return found;
}

std::string nodes_key(const Body& body, const char* of, std::size_t number) {
  return fmt::format("body.{}.{}.{}.nodes", body.name, of, number);
}

/// Region of a cable that is described; its elements are as much longer than in the mesh as it is.
fem::Region cable_region(const CableDescription& cable, const fem::Mesh& mesh) {
  fem::Region region = cable.region;
  if (cable.length == 0.0) return region;
  const std::vector<int>& lines = mesh.element_sets.at(cable.name).lines;
  double straight = 0.0;
  for (const int line : lines) straight += (mesh.nodes[mesh.lines[line][1]] - mesh.nodes[mesh.lines[line][0]]).norm();
  const double cables = static_cast<double>(lines.size()) / cable.elements;
  std::get<fem::Cable>(region.kind).length_ratio = cable.length * cables / straight;
  return region;
}

fem::Model make_model(const Case& c, const Body& description, const fem::Mesh& mesh) {
  const ElasticBody& body = elastic(description);
  fem::Model model{mesh, regions_of(body, mesh), {}, body.structure};
  if (c.contact) model.options.integrator = fem::Integrator::explicit_scheme;  // the only one that knows contact
  for (const HoldDescription& hold : body.holds) {
    const std::string key = nodes_key(description, "hold", model.loads.holds.size());
    model.loads.holds.push_back(hold.hold);
    model.loads.holds.back().nodes = find_nodes(c, key, hold.nodes, mesh);
  }
  for (const ForceDescription& force : body.forces) {
    const std::string key = nodes_key(description, "force", model.loads.forces.size());
    model.loads.forces.push_back({find_nodes(c, key, force.nodes, mesh), force.force});
  }
  for (const PointDescription& point : body.points) {
    model.loads.masses.push_back({mesh.node_sets.at(point.name).front(), point.mass});
  }
  model.loads.pressures = body.pressures;
  model.loads.gravity = body.gravity;
  model.loads.damping = body.damping;
  model.loads.stiffness_damping = body.stiffness_damping;
  return model;
}

fem::Structure make_structure(const Case& c, const Body& body, const fem::Mesh& mesh) {
  fem::Model model = make_model(c, body, mesh);
  std::optional<fem::Structure> structure;
  at_key(c, "body." + body.name, [&] { structure.emplace(std::move(model)); });
  return std::move(*structure);
}

int point_nearest(const fem::Structure& structure, const Vec3& place) {
  int nearest = 0;
  const int points = static_cast<int>(structure.inertia().point.size());
  for (int p = 1; p < points; ++p) {
    const double distance = (structure.mean_position(p) - place).squaredNorm();
    if (distance < (structure.mean_position(nearest) - place).squaredNorm()) nearest = p;
  }
  return nearest;
}

/// Between two advances of a structure [s].
double structure_step(const Case& c) {
  return c.has_fluid() ? time_step(c, level_of(c.domain.coarsest, c.finest)) : c.structure.step;
}

double sum(std::span<const double> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace

std::vector<fem::Region> regions_of(const ElasticBody& body, const fem::Mesh& mesh) {
  std::vector<fem::Region> regions = body.regions;
  for (const CableDescription& cable : body.cables) regions.push_back(cable_region(cable, mesh));
  return regions;
}

CoupledElasticBody::CoupledElasticBody(const Case& c, const Body& body, const fem::Mesh& mesh,
                                       const amr::Forest* forest)
    : CoupledBody(body), case_(c), structure_(make_structure(c, body, mesh)) {
  if (forest) coupling_.emplace(structure_, *forest, elastic(body).coupling);
  const Box box = bounding_box(mesh);
  centre_point_ = point_nearest(structure_, 0.5 * (box.lower + box.upper));
  centre_reference_ = structure_.mean_position(centre_point_);
  for (const Probe& probe : elastic(body).probes) probed_nodes_.push_back(node_nearest(mesh, probe.place));
}

void CoupledElasticBody::step_alone(double time, double dt) {
  const Timed timed(time_alone_);
  if (!case_.structure.at_rest) {
    structure_.advance(dt, time);
    return;
  }
  at_key(case_, "body." + description.name,
         [&] { structure_.find_equilibrium(time + dt, case_.structure.equilibrium); });
  if (warning_.empty()) warning_ = structure_.free_motion();
}

std::string CoupledElasticBody::solver() const {
  if (case_.structure.at_rest) {
    const fem::Equilibrium asked = case_.structure.equilibrium.method;
    const fem::Equilibrium method = asked == fem::Equilibrium::cheaper ? structure_.cheaper_equilibrium() : asked;
    return method == fem::Equilibrium::newton ? "newton" : "relaxation";
  }
  const bool implicit = structure_.integrator_for(structure_step(case_)) == fem::Integrator::implicit_scheme;
  return implicit ? "implicit" : "explicit";
}

BodyRow CoupledElasticBody::measure(const fluid::FluidSolver* fluid) {
  BodyRow row;
  row.centre = structure_.mean_position(centre_point_) - centre_reference_;
  row.reaction = structure_.reaction();
  row.elastic_energy = structure_.elastic_energy();
  row.kinetic_energy = structure_.kinetic_energy();
  row.face_difference = structure_.face_velocity_difference();
  row.thickness_stretch = structure_.mean_thickness_stretch();
  row.plane_stress = structure_.plane_stress_comparison();
  row.volume_ratio = structure_.volume_ratio_range();
  row.substeps = structure_.substeps();
  const auto& probes = elastic(description).probes;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const Vec3 moved = structure_.position()[probed_nodes_[k]] - structure_.mesh().nodes[probed_nodes_[k]];
    row.probes.push_back(moved.dot(probes[k].direction) / probes[k].scale);
  }
  if (!fluid) return row;
  row.force = coupling_->take_mean_force();
  const std::array<double, 2> slip = coupling_->slip(fluid->fine_velocity());
  row.slip_normal = slip[0];
  row.slip_rms = slip[1];
  return row;
}

void CoupledElasticBody::write(const std::filesystem::path& file, double time) const {
  io::write_canopy(file, structure_.mesh(), structure_.position(), structure_.velocity(), {}, time);
}

void CoupledElasticBody::transfer_state(Archive& archive) {
  archive.transfer("structure", structure_);
  if (coupling_) archive.transfer("coupling", *coupling_);
}

double CoupledElasticBody::structure_seconds() const {
  return coupling_ ? coupling_->structure_seconds() : time_alone_.seconds();
}

std::string CoupledElasticBody::report(const Case& c) const {
  const fem::Structure& s = structure_;
  const double step = structure_step(c);
  std::string text = fmt::format("body    {}: {} nodes, {} elements, mass {:.4g} kg", description.name,
                                 s.mesh().nodes.size(), s.elements(), sum(s.own_mass()));
  if (coupling_) {
    text += fmt::format("; {} points on the fluid, {:.4g} kg with the fluid they drag", coupling_->points(),
                        sum(s.inertia().mass));
  }
  text += fmt::format("\n        {}; stable explicit step {:.3g} s, {:.0f} sub-steps in a {} of {:.3g} s\n", solver(),
                      s.stable_step(), s.explicit_substeps(step), coupling_ ? "fine step" : "step", step);
  for (const auto& [nodes, hold] : elastic(description).holds) {
    const std::vector<int> held = nodes_named(s.mesh(), nodes.name, nodes.patch);
    double volume = 0.0;
    for (int node : held) volume += s.volume()[node];
    text += fmt::format("        holds {}: {} nodes, {}\n", nodes.name, held.size(),
                        hold.rigid ? "rigid" : fmt::format("{:.4g} N/m in all", hold.stiffness * volume));
  }
  return text;
}

}  // namespace drogue::app
