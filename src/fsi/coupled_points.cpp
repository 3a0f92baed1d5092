// SPDX-License-Identifier: GPL-3.0-or-later
// A step multiplies the slip of a mode that the delta function sees with the gain g in [0, 1] by m / (m + M) (1 - g),
// with m the excess and M the dragged mass: it decays for every m >= 0, and for a negative one as long as -m < m + M.
#include "fsi/coupled_points.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "core/error.hpp"
#include "fem/thin_solid.hpp"
#include "ib/dragged_mass.hpp"

namespace drogue::fsi {

namespace {

/// Of the nodes of coupled regions.
std::vector<std::array<int, 2>> pairs_then_single_nodes(const fem::Structure& structure, double spacing) {
  const std::span<const double> volume = structure.coupled_volume();
  std::vector<std::array<int, 2>> nodes = fem::thickness_pairs(structure.mesh(), spacing);
  std::erase_if(nodes, [&](const auto& pair) { return volume[pair[0]] == 0.0 || volume[pair[1]] == 0.0; });
  std::vector<bool> paired(volume.size(), false);
  for (const auto& [a, b] : nodes) paired[a] = paired[b] = true;
  for (std::size_t node = 0; node < paired.size(); ++node) {
    if (!paired[node] && volume[node] > 0.0) nodes.push_back({static_cast<int>(node), -1});
  }
  return nodes;
}

/// Of pairs and of surfaces that are not the faces of a solid. Which node of a pair comes first says nothing of the
/// side it is on, so the normals are turned towards the positive side of the direction that most of them share.
std::vector<Vec3> normals(const fem::Mesh& mesh, const std::vector<std::array<int, 2>>& nodes) {
  std::vector<Vec3> normal(nodes.size(), Vec3::Zero());
  const std::vector<Vec3> of_surface =
      mesh.hexahedra.empty() ? area_normals(mesh) : std::vector<Vec3>(mesh.nodes.size(), Vec3::Zero());
  Mat3 sum = Mat3::Zero();
  for (std::size_t p = 0; p < nodes.size(); ++p) {
    const auto [a, b] = nodes[p];
    normal[p] = (b < 0 ? of_surface[a] : Vec3(mesh.nodes[b] - mesh.nodes[a])).normalized();
    sum += normal[p] * normal[p].transpose();
  }
  Vec3 shared = Eigen::SelfAdjointEigenSolver<Mat3>(sum).eigenvectors().col(2);
  if (shared.sum() < 0.0) shared = -shared;
  for (Vec3& n : normal) {
    if (n.dot(shared) < 0.0) n = -n;
  }
  return normal;
}

std::vector<double> dragged_masses(const fem::Structure& structure, const std::vector<std::array<int, 2>>& nodes,
                                   ib::Delta delta, double spacing, double density) {
  const fem::Mesh& mesh = structure.mesh();
  std::vector<std::array<int, 2>> pairs;
  for (const auto& point : nodes) {
    if (point[1] >= 0) pairs.push_back(point);
  }
  std::vector<double> mass = ib::mass_dragged_by_sheet(delta, fem::pair_areas(mesh, pairs), spacing, density);
  if (mass.size() < nodes.size()) {
    const auto of_cloud = ib::mass_dragged_by_cloud(delta, mesh.nodes, structure.coupled_volume(), spacing, density);
    for (std::size_t p = mass.size(); p < nodes.size(); ++p) mass.push_back(of_cloud[nodes[p][0]]);
  }
  return mass;
}

}  // namespace

CoupledPoints couple_points(const fem::Structure& structure, ib::Delta delta, double spacing, double density,
                            const std::string& body) {
  CoupledPoints points;
  points.nodes = pairs_then_single_nodes(structure, spacing);
  if (points.nodes.empty()) {
    throw InputError(fmt::format("body '{}': no region is coupled with the fluid; expected at least one", body));
  }
  points.normal = normals(structure.mesh(), points.nodes);
  points.dragged_mass = dragged_masses(structure, points.nodes, delta, spacing, density);
  for (int p = 0; p < points.size(); ++p) {
    double excess = 0.0;
    for (int node : points.nodes[p]) {
      if (node >= 0) excess += structure.own_mass()[node] - density * structure.coupled_volume()[node];
    }
    const double dragged = points.dragged_mass[p];
    if (!(dragged > 0.0 && dragged + 2.0 * excess > 0.0)) {
      throw InputError(
          fmt::format("body '{}': node {} is lighter by {:g} kg than the fluid it displaces, but drags {:g} kg of "
                      "fluid only; expected at "
                      "least twice the difference, or the coupling would be unstable: use a denser solid",
                      body, points.nodes[p][0], -excess, dragged));
    }
    points.excess_mass.push_back(excess);
  }
  return points;
}

fem::Inertia inertia_of(const fem::Structure& structure, const CoupledPoints& points, double density) {
  fem::Inertia inertia{points.nodes, points.dragged_mass, points.excess_mass, {}};
  for (int p = 0; p < points.size(); ++p) {
    inertia.mass[p] += points.excess_mass[p];
    inertia.reset = std::min(inertia.reset, points.excess_mass[p] / inertia.mass[p]);
  }
  for (std::size_t node = 0; node < structure.own_mass().size(); ++node) {
    const double displaced = density * structure.coupled_volume()[node];
    inertia.face_mass.push_back(std::max(structure.own_mass()[node], displaced));
    if (displaced > 0.0) continue;
    inertia.point.push_back({static_cast<int>(node), -1});
    inertia.mass.push_back(structure.own_mass()[node]);
    inertia.heavy_mass.push_back(structure.own_mass()[node]);
  }
  return inertia;
}

CoupledPoints split_into_nodes(const CoupledPoints& points) {
  std::size_t nodes = 0;
  for (const auto& [a, b] : points.nodes) nodes += b < 0 ? 1 : 2;
  CoupledPoints split;
  split.excess_mass.resize(nodes);
  split.dragged_mass.resize(nodes);
  split.normal.resize(nodes);
  for (std::size_t node = 0; node < nodes; ++node) split.nodes.push_back({static_cast<int>(node), -1});
  for (int p = 0; p < points.size(); ++p) {
    const double share = points.nodes[p][1] < 0 ? 1.0 : 0.5;
    for (int node : points.nodes[p]) {
      if (node < 0) continue;
      split.excess_mass[node] = share * points.excess_mass[p];
      split.dragged_mass[node] = share * points.dragged_mass[p];
      split.normal[node] = points.normal[p];
    }
  }
  return split;
}

}  // namespace drogue::fsi
