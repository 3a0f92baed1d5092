// SPDX-License-Identifier: GPL-3.0-or-later
// The weights that join levels along one axis; in space they act as tensor products. Populations move at lattice speed,
// so a second-order mismatch of the velocity at an interface would reach the flow as a first-order force (DESIGN
// section 3, table); hence cubic interpolation and fourth-order restriction.
#pragma once

#include <array>

#include "amr/forest.hpp"

namespace drogue::lbm {

/// Outputs 0 .. 15 along one axis from inputs 0 .. 31, the cells of a pair of adjacent blocks: output i is the sum over
/// k < taps of weight[i][k] * input[start[i] + k]; with the weights `curvature` it is the second derivative there, per
/// input cell squared.
struct Axis {
  static constexpr int most_taps = 5;
  using Weights = std::array<double, most_taps>;
  int taps;
  std::array<int, amr::block_size> start;
  std::array<Weights, amr::block_size> weight, curvature;
};

inline constexpr int interpolation_taps = 4, restriction_taps = 5;

/// Cubic interpolation onto the layer of a ghost next to a fine leaf, along the normal: from three layers of its host,
/// counted from the interface, and the first of the leaf. The curvature is that of the host's part, from four layers.
struct JointStencil {
  Axis::Weights weight, curvature;  ///< of the host's layers
  double leaf_weight;               ///< of the leaf's; the host's share of the sum is 1 less that
};
JointStencil joint_stencil();

/// Cubic interpolation onto the block in octant `half` (0 low, 1 high) of a coarse one; the pair is the coarse block
/// and its neighbour on that side, which the stencils leave alone if it is not `available`.
Axis cubic_axis(int half, bool available);

/// Fourth-order restriction of two fine blocks onto the one that covers them: (-1, 9, 9, -1) / 16, and
/// (6, 11, 1, -3, 1) / 16 at the ends of each of them, so that no neighbour is read; both reproduce cubics and remove
/// the shortest wave, and so do the weights of their curvature.
Axis restriction_axis();

}  // namespace drogue::lbm
