// SPDX-License-Identifier: GPL-3.0-or-later
// All elements of a body: batches for the kernel, and the sum of element forces on the nodes.
#pragma once

#include <array>
#include <atomic>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "fem/hex_kernel.hpp"
#include "fem/hex_mesh.hpp"
#include "fem/material.hpp"

namespace drogue::fem {

/// Functions whose "work is shared" divide it among the threads of the parallel region they are called in and end with
/// a barrier; outside of one they run in the calling thread. A node sums its elements in ascending order, so that
/// results do not depend on the number of threads.
class HexElements {
 public:
  /// `volume_ratio`: bounds of J that compute_forces() watches. Throws InputError for a node number out of range, an
  /// inverted element or a node without element.
  HexElements(const HexMesh& mesh, const Material& material, const std::array<double, 2>& volume_ratio);

  int count() const { return count_; }
  /// As many threads as have enough elements each to be worth their barriers.
  int threads() const;
  /// Reference volume lumped on the nodes [m^3].
  const std::vector<double>& nodal_volume() const { return nodal_volume_; }

  /// Forces of all elements at positions `x`, for nodal_force() to sum. Work is shared.
  void compute_forces(std::span<const Vec3> x);
  /// Force of the elements on a node [N], of the last compute_forces().
  Vec3 nodal_force(int node) const {
    const double* force = reinterpret_cast<const double*>(forces_.data());
    Vec3 sum = Vec3::Zero();
    for (int k = first_slot_[node]; k < first_slot_[node + 1]; ++k) {
      sum += Vec3(force[slot_[k]], force[slot_[k] + lanes], force[slot_[k] + 2 * lanes]);
    }
    return sum;
  }

  /// Whether compute_forces(), since told to forget, met a J that is out of bounds or no number.
  bool out_of_bounds() const { return out_of_bounds_.load(std::memory_order_relaxed); }
  void forget_out_of_bounds() { out_of_bounds_ = false; }
  struct Extreme {
    int element;
    double volume_ratio;
  };
  /// The element that was furthest out of bounds in the last compute_forces().
  Extreme worst() const;

  /// Upper bound of density times squared frequency of each element [Pa/m^2], if the mass that moves along parent
  /// direction I weighs 1 / `lightness[e][I]` times its own (see directional_stiffness()). Work is shared.
  void stiffness_bounds(std::span<const Vec3> x, std::span<const std::array<double, 3>> lightness,
                        std::span<double> bound) const;

  double elastic_energy(std::span<const Vec3> x) const;  ///< [J]
  std::array<double, 2> volume_ratio_range(std::span<const Vec3> x) const;

 private:
  void fill_batches(const HexMesh& mesh);
  void check_not_inverted(const HexMesh& mesh) const;
  void connect_nodes(const HexMesh& mesh);
  void lump_volumes(const HexMesh& mesh);

  Material material_;
  std::array<double, 2> bounds_;
  int count_ = 0;
  std::vector<ElementBatch> batches_;
  std::vector<double> nodal_volume_;
  std::vector<NodalForces> forces_;
  std::vector<VolumeRatio> ratios_;
  std::vector<int> first_slot_;  ///< of each node in `slot_`
  std::vector<int> slot_;        ///< where the elements of a node keep their x force, in doubles of `forces_`
  std::atomic<bool> out_of_bounds_ = false;
};

}  // namespace drogue::fem
