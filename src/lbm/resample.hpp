// SPDX-License-Identifier: GPL-3.0-or-later
// Tensor-product resampling from one level to the next, the one mechanism that joins levels: cubic interpolation of
// coarse leaves onto the rim of a ghost, fourth-order restriction of fine leaves onto the rim of a parent. Populations
// move at lattice speed, so a second-order mismatch of the velocity at an interface would reach the flow as a
// first-order force (DESIGN section 3, table); hence the orders.
//
// A rim is a stack of layers, a layer is made of lines, a line is 16 cells whose ten moments are adjacent. Next to a y
// or z face lines are rows; next to an x face they are columns along y, so that no face is more expensive than another.
#pragma once

#include <array>

#include "amr/forest.hpp"
#include "lbm/moments.hpp"

namespace drogue::lbm {

/// Outputs 0 .. 15 along one axis from inputs 0 .. 31, the cells of a pair of adjacent blocks: output i is the sum over
/// k < taps of weight[i][k] * input[start[i] + k].
struct Axis {
  static constexpr int most_taps = 5;
  int taps;
  std::array<int, amr::block_size> start;
  std::array<std::array<double, most_taps>, amr::block_size> weight;
};

/// Cubic interpolation onto the block in octant `half` (0 low, 1 high) of a coarse one; the pair is the coarse block
/// and its neighbour on that side, which the stencils leave alone if it is not `available`.
Axis cubic_axis(int half, bool available);

/// Fourth-order restriction of two fine blocks onto the one that covers them: (-1, 9, 9, -1) / 16, and
/// (6, 11, 1, -3, 1) / 16 at the ends of each of them, so that no neighbour is read; both reproduce cubics and remove
/// the shortest wave.
Axis restriction_axis();

/// Which of these an axis of a job uses: an interpolation has number 2 * half + available.
inline constexpr int restriction_rule = 4;
Axis axis_of_rule(int rule);

/// Part of the rim of `target`: `layers` stacked along `normal` (0 x, 1 y, 2 z), of each the `lines` that stand side by
/// side across(), of each the `cells` along(), all as half-open ranges.
struct ResampleJob {
  struct Range {
    int begin, end;
  };
  int target, normal;
  Range layers, lines, cells;
  std::array<int, 3> rule;    ///< normal, across, along
  std::array<int, 8> source;  ///< pairs of blocks [normal][across][along]
  bool also_rows = false;     ///< of columns: write the cells of the rows as well

  int across() const { return normal == 2 ? 1 : 2; }
  int along() const { return normal == 0 ? 1 : 0; }
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
  Vec3 velocity_shift = Vec3::Zero();  ///< added to the velocity, lattice units
};

/// Runs jobs; knows the weights.
template <class S>
class Resampler {
 public:
  explicit Resampler(const amr::Forest& forest);

  void operator()(const ResampleJob& job, const SourceFields<S>& source, const Conversion& conversion,
                  MomentField<S>& target) const;

 private:
  using Real = typename S::Real;

  /// An axis in the precision of the state, with lane numbers for lines that are combined along themselves.
  struct Stencil {
    std::array<int, amr::block_size> start;
    std::array<std::array<Real, Axis::most_taps>, amr::block_size> weight;
    std::array<IndexVec<Real>, Axis::most_taps> lane;
    std::array<Vec<Real>, Axis::most_taps> lane_weight;

    explicit Stencil(const Axis& axis);
  };

  template <int taps, bool midway>
  void run(const ResampleJob& job, const SourceFields<S>& source, const Conversion& conversion,
           MomentField<S>& target) const;

  const amr::Forest& forest_;
  std::array<Stencil, 5> stencil_;  // by rule
};

}  // namespace drogue::lbm
