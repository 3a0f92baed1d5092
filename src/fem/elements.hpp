// SPDX-License-Identifier: GPL-3.0-or-later
// All elements of a body, whatever their families, and the pressure on its faces: their forces summed on the nodes.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "fem/element_group.hpp"
#include "fem/loads.hpp"
#include "fem/pressure.hpp"

namespace drogue::fem {

/// Functions whose "work is shared" divide it among the threads of the parallel region they are called in and end with
/// a barrier; outside of one they run in the calling thread. A node sums its elements in a fixed order, so that results
/// do not depend on the number of threads.
class Elements {
 public:
  /// `regions` outlive it; `volume_ratio`: bounds of J that compute_forces() watches. Throws InputError for a region
  /// without elements, an element in two regions, a node number out of range, an inverted element or a node without
  /// element.
  Elements(const Mesh& mesh, const std::vector<Region>& regions, const std::vector<Pressure>& pressures,
           const std::array<double, 2>& volume_ratio);

  /// Those of the first region first, quadrilaterals before triangles.
  const std::vector<std::unique_ptr<ElementGroup>>& groups() const { return groups_; }
  /// All that have forces: groups(), then the faces that bear a pressure.
  std::vector<const ForceGroup*> force_groups() const;
  int count() const;
  /// As many threads as have enough elements each to be worth their barriers.
  int threads() const;
  const std::vector<double>& nodal_volume() const { return nodal_volume_; }      ///< reference volume lumped [m^3]
  const std::vector<double>& coupled_volume() const { return coupled_volume_; }  ///< of coupled regions alone [m^3]
  const std::vector<double>& nodal_mass() const { return nodal_mass_; }          ///< own mass lumped [kg]

  /// A share of the pressures and active stresses of `time` [s] acts from now on.
  void set_time(double time, double share = 1.0);
  bool vary() const;  ///< whether they change with time
  /// Forces of all elements and faces at positions `x`, for nodal_force() to sum. Work is shared.
  void compute_forces(std::span<const Vec3> x);
  /// Force on a node [N], of the last compute_forces().
  Vec3 nodal_force(int node) const { return sum(first_slot_[node], first_slot_[node + 1]); }
  /// The part of it that is pressure.
  Vec3 nodal_load(int node) const { return sum(first_load_[node], first_slot_[node + 1]); }

  /// Whether compute_forces(), since told to forget, met a J that is out of bounds or no number.
  bool out_of_bounds() const { return out_of_bounds_.load(std::memory_order_relaxed); }
  void forget_out_of_bounds() { out_of_bounds_ = false; }
  struct Extreme {
    const ElementGroup* group;
    int element;
    double volume_ratio;
  };
  /// The element that was furthest out of bounds in the last compute_forces().
  Extreme worst() const;

  /// Largest squared frequency [1/s^2] at positions `x` of nodes of `mass` [kg], from above: the largest ratio of
  /// nodal_stiffness() to it.
  double largest_squared_frequency(std::span<const Vec3> x, std::span<const double> mass);
  /// The node that decided the last of these.
  int stiffest_node() const { return stiffest_node_; }
  /// Diagonal matrix [N/m] that exceeds the stiffness matrix at positions `x`.
  std::vector<double> nodal_stiffness(std::span<const Vec3> x);

  double elastic_energy(std::span<const Vec3> x) const;  ///< [J]
  std::array<double, 2> volume_ratio_range(std::span<const Vec3> x) const;

 private:
  void add_region(const Mesh& mesh, const Region& region, const std::array<double, 2>& volume_ratio);
  void expect_one_region_each() const;
  void lump(std::size_t nodes);
  void connect_nodes(const Mesh& mesh);
  Vec3 sum(int first, int last) const {
    Vec3 sum = Vec3::Zero();
    for (int k = first; k < last; ++k) {
      const double* force = slot_[k];
      sum += Vec3(force[0], force[lanes], force[2 * lanes]);
    }
    return sum;
  }

  struct Faces {
    Expression pressure;
    std::vector<std::unique_ptr<PressureGroup>> groups;
  };
  std::vector<std::unique_ptr<ElementGroup>> groups_;
  std::vector<Faces> faces_;
  std::vector<double> nodal_volume_, coupled_volume_, nodal_mass_;
  std::vector<int> first_slot_;           ///< of each node in `slot_`, its elements before its faces
  std::vector<int> first_load_;           ///< the first of a face
  std::vector<const double*> slot_;       ///< where the elements of a node keep their force on it
  std::vector<const double*> stiffness_;  ///< and their stiffness; of faces none
  int stiffest_node_ = 0;
  std::atomic<bool> out_of_bounds_ = false;
};

}  // namespace drogue::fem
