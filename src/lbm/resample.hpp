// SPDX-License-Identifier: GPL-3.0-or-later
// Tensor-product resampling of a box of one block onto a box of another, the one mechanism that joins levels:
// cubic interpolation of a coarse leaf onto the rim of a ghost, fourth-order restriction of fine leaves onto a parent.
// Populations move at lattice speed, so a second-order mismatch of the velocity at an interface would reach the flow as
// a first-order force (DESIGN section 3, table); hence the orders.
#pragma once

#include <array>

#include "amr/forest.hpp"
#include "lbm/moments.hpp"

namespace drogue::lbm {

/// One axis: output i in [begin, end) is the sum over k < taps of weight[i][k] * input[start[i] + k]. Inputs may lie up
/// to two cells outside the source block.
struct Axis {
  static constexpr int most_taps = 5;
  int begin, end, taps;
  std::array<int, amr::block_size> start;
  std::array<std::array<double, most_taps>, amr::block_size> weight;

  int outputs() const { return end - begin; }
  int first_input() const;
  int last_input() const;
  int inputs() const { return last_input() + 1 - first_input(); }
};

/// Cubic interpolation onto cells [begin, end) of the ghost in octant `half` (0 low, 1 high) of a coarse block;
/// stencils keep out of the neighbour on a side that is not `available` {low, high}.
Axis cubic_axis(int begin, int end, int half, std::array<bool, 2> available);

/// Fourth-order restriction of a fine block onto coarse cells [begin, end) of the eight it covers: (-1, 9, 9, -1) / 16,
/// and (6, 11, 1, -3, 1) / 16 at the ends of the block, so that no neighbour is read; both reproduce cubics and remove
/// the shortest wave.
Axis restriction_axis(int begin, int end);

/// A box of `target` computed from `source` and its neighbours on its level.
struct ResampleJob {
  int source, target;
  std::array<Axis, 3> axis;
  std::array<int, 3> shift;  ///< added to an output index to give the cell of the target
};

/// Where a source finds its values: leaves in `leaves`, or half-way between `leaves` and `leaves_end` if that is given;
/// parents, which are restricted anew for each transfer, in `parents`.
template <class S>
struct SourceFields {
  const MomentField<S>& leaves;
  const MomentField<S>* leaves_end;
  const MomentField<S>& parents;
};

/// What differs between the states of two levels.
struct Conversion {
  double stress_factor = 1.0;          ///< of the stress, which scales with tau and the time step
  Vec3 velocity_shift = Vec3::Zero();  ///< added to the velocity, lattice units (lbm/body_force.cpp)
};

template <class S>
void resample(const ResampleJob& job, const amr::Forest& forest, const SourceFields<S>& source,
              const Conversion& conversion, MomentField<S>& target);

}  // namespace drogue::lbm
