// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/elastic_body.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "app/case_checks.hpp"
#include "core/nearest_name.hpp"
#include "io/canopy.hpp"

namespace drogue::app {

namespace {

const ElasticBody& elastic(const Body& body) { return std::get<ElasticBody>(body.kind); }

/// The nodes of a hold on a mesh. Throws InputError if there are none.
std::vector<int> held_nodes(const Case& c, const Body& body, const HoldDescription& hold, const fem::HexMesh& mesh) {
  std::vector<int> nodes;
  std::vector<std::string> known{"corners", "all"};
  for (const auto& [name, set] : mesh.node_sets) known.push_back(name);
  if (hold.nodes == "corners") {
    nodes = fem::corner_nodes(mesh, hold.patch);
  } else if (hold.nodes == "all") {
    nodes.resize(mesh.nodes.size());
    std::iota(nodes.begin(), nodes.end(), 0);
  } else if (const auto set = mesh.node_sets.find(hold.nodes); set != mesh.node_sets.end()) {
    nodes = set->second;
  } else {
    fail(c, fmt::format("body.{}.hold", body.name),
         fmt::format("names the node set \"{}\", which its mesh does not have{}", hold.nodes,
                     did_you_mean(hold.nodes, known)));
  }
  if (nodes.empty()) {
    fail(c, fmt::format("body.{}.hold", body.name), fmt::format("holds no node: the set \"{}\" is empty", hold.nodes));
  }
  return nodes;
}

std::vector<fem::Hold> make_holds(const Case& c, const Body& body, const fem::HexMesh& mesh) {
  std::vector<fem::Hold> holds;
  for (const HoldDescription& hold : elastic(body).holds) {
    holds.push_back({held_nodes(c, body, hold, mesh), hold.rigid, hold.stiffness, hold.damping});
  }
  return holds;
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

Vec3 middle(const fem::HexMesh& mesh) {
  Vec3 lower = mesh.nodes.front(), upper = lower;
  for (const Vec3& node : mesh.nodes) {
    lower = lower.cwiseMin(node);
    upper = upper.cwiseMax(node);
  }
  return 0.5 * (lower + upper);
}

double sum(std::span<const double> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace

CoupledElasticBody::CoupledElasticBody(const Case& c, const Body& body, fem::HexMesh mesh, const amr::Forest& forest)
    : CoupledBody(body),
      structure_(mesh, elastic(body).material, elastic(body).structure, make_holds(c, body, mesh)),
      coupling_(structure_, forest, elastic(body).coupling),
      centre_point_(point_nearest(structure_, middle(mesh))),
      centre_reference_(structure_.mean_position(centre_point_)) {}

BodyRow CoupledElasticBody::measure(const fluid::FluidSolver& fluid) {
  const std::array<double, 2> slip = coupling_.slip(fluid.fine_velocity());
  BodyRow row;
  row.force = coupling_.take_mean_force();
  row.centre = structure_.mean_position(centre_point_) - centre_reference_;
  row.reaction = structure_.reaction();
  row.elastic_energy = structure_.elastic_energy();
  row.kinetic_energy = structure_.kinetic_energy();
  row.face_difference = structure_.face_velocity_difference();
  row.thickness_stretch = structure_.mean_thickness_stretch();
  row.plane_stress = structure_.plane_stress_comparison();
  row.volume_ratio = structure_.volume_ratio_range();
  row.slip_normal = slip[0];
  row.slip_rms = slip[1];
  row.substeps = structure_.substeps();
  return row;
}

void CoupledElasticBody::write(const std::filesystem::path& file, double time) const {
  io::write_canopy(file, structure_.mesh(), structure_.position(), structure_.velocity(), {}, time);
}

void CoupledElasticBody::transfer_state(Archive& archive) {
  archive.transfer("structure", structure_);
  archive.transfer("coupling", coupling_);
}

std::string CoupledElasticBody::report(const Case& c) const {
  const fem::Structure& s = structure_;
  const double stable = s.stable_step(), step = time_step(c, level_of(c.domain.coarsest, c.finest));
  std::string text = fmt::format(
      "body    {}: {} nodes, {} elements, {} points on the fluid; mass {:.4g} kg, {:.4g} kg with the fluid it drags\n"
      "        stable step {:.3g} s, {:.0f} sub-steps in a fine step of {:.3g} s\n",
      description.name, s.mesh().nodes.size(), s.mesh().elements.size(), s.inertia().point.size(), sum(s.own_mass()),
      sum(s.inertia().mass), stable, std::ceil(step / stable), step);
  for (const HoldDescription& hold : elastic(description).holds) {
    const std::vector<int> nodes = held_nodes(c, description, hold, s.mesh());
    double volume = 0.0;
    for (int node : nodes) volume += s.volume()[node];
    text += fmt::format("        holds {}: {} nodes, {}\n", hold.nodes, nodes.size(),
                        hold.rigid ? "rigid" : fmt::format("{:.4g} N/m in all", hold.stiffness * volume));
  }
  return text;
}

}  // namespace drogue::app
