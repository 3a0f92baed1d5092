// SPDX-License-Identifier: GPL-3.0-or-later
// Cubic interpolation of coarse leaves, and along the normal of an interface of the fine ones beyond it, onto the rims
// of the ghosts of the next finer level, in two stages: layers of a coarse leaf are combined along the normal of a rim,
// once for all rims that read them and while that leaf is updated; the sums, planes of 16 lines, are then combined in
// the plane. Between two fine steps they are taken half-way through the coarse step.
#pragma once

#include <array>
#include <vector>

#include "core/huge_array.hpp"
#include "lbm/by_leaf.hpp"
#include "lbm/layer_sums.hpp"
#include "lbm/lines.hpp"

namespace drogue::lbm {

/// A sum of layers of a coarse leaf, of which some lines are needed.
struct LeafSum {
  int leaf;
  LayerSum sum;
  Range lines;
};

/// Part of the rim of a ghost: of its layer `layer` along `normal` the `lines` that stand side by side across, of each
/// the `cells` along. Next to a face of a fine leaf, `beside`, that leaf has a share in it (joint_stencil()).
struct RimJob {
  int target, normal, layer;
  int beside;  ///< or none
  Range lines, cells;
  int across_rule, along_rule;                           ///< see axis_of_rule()
  std::array<std::array<std::array<int, 2>, 2>, 2> sum;  ///< [across][along] of the pairs: two terms, or one and none
  bool copy;                                             ///< see copy_line()
};

/// Jobs sorted by target; `first[i]` .. `first[i + 1]` share the i-th target, so targets may be filled in parallel.
struct InterpolationPlan {
  std::vector<LeafSum> sum;
  std::vector<RimJob> job;
  std::vector<int> first{0};
};

inline constexpr int cubic_rules = 4;
/// Rule 2 * half + available of cubic_axis().
inline Axis axis_of_rule(int rule) { return cubic_axis(rule / 2, rule % 2); }

/// Onto the ghosts of one level.
template <class S>
class Interpolation {
 public:
  /// `curvature` [coarse cells squared] is what levels differ by in moments that is_curved().
  Interpolation(const amr::Forest& forest, int level, double curvature);

  /// Takes the coarse field between two of its steps, from a state of which nothing has been taken yet.
  void start(const MomentField<S>& coarse);
  /// Asks for the sums of a coarse leaf that is about to be updated.
  void request(int leaf, LayerSums<S>& sums);
  /// Half-way through a step: the mean of what was taken last and of the end of the step in `coarse_end`.
  void take_half_way(const MomentField<S>& coarse_end);
  /// The end of the step, which take_half_way() has seen.
  void take_end() { now_ = 1 - now_; }
  /// Fills the rims of the ghosts in `fine` from what was taken last.
  void fill_rims(const Conversion& conversion, MomentField<S>& fine) const;

 private:
  using Real = typename S::Real;

  template <class F>
  void for_each_sum(const F& f) const;
  void take(const LeafSum& sum, const MomentField<S>& field, Plane<S>& plane) const;
  void fill(const RimJob& job, const Conversion& conversion, MomentField<S>& fine) const;

  const InterpolationPlan plan_;
  const double curvature_;
  const Real leaf_weight_;  // see joint_stencil()
  const std::array<Stencil<Real>, cubic_rules> stencil_;
  ByLeaf<int> of_leaf_;                        // numbers of its sums
  std::array<HugeVector<Plane<S>>, 2> plane_;  // by sum
  int now_ = 0;  // which of them stands at the time of the fine level; the other at the end of the coarse step
};

}  // namespace drogue::lbm
