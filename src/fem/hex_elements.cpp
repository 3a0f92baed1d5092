// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/hex_elements.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>

#include "core/error.hpp"
#include "fem/hex_topology.hpp"

namespace drogue::fem {

HexElements::HexElements(const HexMesh& mesh, const Material& material, const std::array<double, 2>& volume_ratio)
    : material_(material), bounds_(volume_ratio), count_(static_cast<int>(mesh.elements.size())) {
  if (count_ == 0) throw InputError("the mesh has no hexahedra; expected at least one");
  fill_batches(mesh);
  check_not_inverted(mesh);
  connect_nodes(mesh);
  lump_volumes(mesh);
}

int HexElements::threads() const {
  constexpr int fewest_elements = 256;
  return std::clamp(count_ / fewest_elements, 1, omp_get_max_threads());
}

void HexElements::fill_batches(const HexMesh& mesh) {
  const int nodes = static_cast<int>(mesh.nodes.size());
  for (int e = 0; e < count_; ++e) {
    for (const int node : mesh.elements[e]) {
      if (node < 0 || node >= nodes) {
        throw InputError(fmt::format("element {} names node {}; expected 0 to {}", e, node, nodes - 1));
      }
    }
  }
  batches_.resize((count_ + lanes - 1) / lanes);
  forces_.resize(batches_.size());
  ratios_.resize(batches_.size());
  for (std::size_t b = 0; b < batches_.size(); ++b) {
    for (int lane = 0; lane < lanes; ++lane) {
      // Spare lanes repeat the last element; nobody reads their forces.
      const auto& element = mesh.elements[std::min(static_cast<int>(b) * lanes + lane, count_ - 1)];
      for (int a = 0; a < 8; ++a) batches_[b].node[a][lane] = element[a];
    }
    prepare_geometry(batches_[b], mesh.nodes);
  }
}

void HexElements::check_not_inverted(const HexMesh& mesh) const {
  for (int e = 0; e < count_; ++e) {
    for (const auto& point : batches_[e / lanes].point) {
      if (point.weight[e % lanes] > 0.0) continue;
      const Vec3& p = mesh.nodes[mesh.elements[e][0]];
      throw InputError(
          fmt::format("element {} near ({:g}, {:g}, {:g}) m is flat or inverted in the reference configuration "
                      "(Jacobian {:g} m^3); "
                      "expected the nodes of a convex hexahedron, bottom face counter-clockwise, then top face",
                      e, p.x(), p.y(), p.z(), point.weight[e % lanes]));
    }
  }
}

void HexElements::connect_nodes(const HexMesh& mesh) {
  first_slot_.assign(mesh.nodes.size() + 1, 0);
  for (const auto& element : mesh.elements) {
    for (const int node : element) ++first_slot_[node + 1];
  }
  for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
    if (first_slot_[node + 1] == 0) {
      const Vec3& p = mesh.nodes[node];
      throw InputError(
          fmt::format("node {} at ({:g}, {:g}, {:g}) m is unconnected; expected every node to belong to an element",
                      node, p.x(), p.y(), p.z()));
    }
    first_slot_[node + 1] += first_slot_[node];
  }
  slot_.resize(first_slot_.back());
  std::vector<int> next(first_slot_.begin(), first_slot_.end() - 1);
  for (int e = 0; e < count_; ++e) {
    for (int a = 0; a < 8; ++a) slot_[next[mesh.elements[e][a]]++] = ((e / lanes) * 8 + a) * 3 * lanes + e % lanes;
  }
}

void HexElements::lump_volumes(const HexMesh& mesh) {
  constexpr double near = 0.5 * (1.0 + gauss_abscissa), far = 1.0 - near;
  // Corners of the parent cube in the order of an element's nodes, as bits of (xi, eta, zeta).
  constexpr int corner[8] = {0, 1, 3, 2, 4, 5, 7, 6};
  nodal_volume_.assign(mesh.nodes.size(), 0.0);
  for (int e = 0; e < count_; ++e) {
    for (int a = 0; a < 8; ++a) {
      for (int q = 0; q < 8; ++q) {
        double shape = 1.0;
        for (int axis = 0; axis < 3; ++axis) shape *= ((corner[a] ^ q) >> axis) & 1 ? far : near;
        nodal_volume_[mesh.elements[e][a]] += shape * batches_[e / lanes].point[q].weight[e % lanes];
      }
    }
  }
}

void HexElements::compute_forces(std::span<const Vec3> x) {
  std::visit(
      [&](const auto& law) {
#pragma omp for schedule(static)
        for (std::size_t b = 0; b < batches_.size(); ++b) {
          const VolumeRatio j = nodal_forces(law, batches_[b], x, forces_[b]);
          ratios_[b] = j;
          bool inside = true;
          for (int lane = 0; lane < lanes; ++lane)
            inside &= j.smallest[lane] >= bounds_[0] && j.largest[lane] <= bounds_[1];
          if (!inside) out_of_bounds_.store(true, std::memory_order_relaxed);
        }
      },
      material_);
}

HexElements::Extreme HexElements::worst() const {
  Extreme low{0, bounds_[0]}, high{0, bounds_[1]};
  for (int e = 0; e < count_; ++e) {
    const double smallest = ratios_[e / lanes].smallest[e % lanes], largest = ratios_[e / lanes].largest[e % lanes];
    if (!(smallest >= low.volume_ratio)) low = {e, smallest};
    if (!(largest <= high.volume_ratio)) high = {e, largest};
    if (smallest != smallest) return low;
  }
  return low.volume_ratio < bounds_[0] ? low : high;
}

void HexElements::stiffness_bounds(std::span<const Vec3> x, std::span<const std::array<double, 3>> lightness,
                                   std::span<double> bound) const {
  std::visit(
      [&](const auto& law) {
#pragma omp for schedule(static)
        for (std::size_t b = 0; b < batches_.size(); ++b) {
          const std::array<Pack, 3> stiffness = directional_stiffness(law, batches_[b], x);
          const int first = static_cast<int>(b) * lanes;
          for (int e = first; e < std::min(first + lanes, count_); ++e) {
            bound[e] = 0.0;
            for (int direction = 0; direction < 3; ++direction) {
              bound[e] += lightness[e][direction] * stiffness[direction][e - first];
            }
          }
        }
      },
      material_);
}

double HexElements::elastic_energy(std::span<const Vec3> x) const {
  double sum = 0.0;
  std::visit(
      [&](const auto& law) {
        for (int e = 0; e < count_; e += lanes) {
          const Pack energy = fem::elastic_energy(law, batches_[e / lanes], x);
          for (int lane = 0; lane < std::min(lanes, count_ - e); ++lane) sum += energy[lane];
        }
      },
      material_);
  return sum;
}

std::array<double, 2> HexElements::volume_ratio_range(std::span<const Vec3> x) const {
  std::array<double, 2> range{INFINITY, -INFINITY};
  for (const ElementBatch& batch : batches_) {
    const VolumeRatio j = volume_ratio(batch, x);
    for (int lane = 0; lane < lanes; ++lane) {
      range[0] = std::min(range[0], j.smallest[lane]);
      range[1] = std::max(range[1], j.largest[lane]);
    }
  }
  return range;
}

}  // namespace drogue::fem
