// SPDX-License-Identifier: GPL-3.0-or-later
// Fourth-order restriction of fine leaves onto the layer of the parent that covers them which coarse leaves stream
// from, at the end of a coarse step. The stencils stay inside a leaf, so its rim is summed up while it is updated and
// nothing is read again.
#pragma once

#include <array>
#include <vector>

#include "lbm/by_leaf.hpp"
#include "lbm/layer_sums.hpp"
#include "lbm/lines.hpp"

namespace drogue::lbm {

/// A face of a leaf whose cells a parent needs.
struct RimFace {
  int face;   ///< 0 to 5
  bool copy;  ///< the lines of the parent, see copy_line()
};

using RestrictionPlan = ByLeaf<RimFace>;

/// Restricts one leaf at a time: request(), the rows, write(). About 60 KB.
template <class S>
class Restriction {
 public:
  /// `curvature` [fine cells squared] is what levels differ by in moments that is_curved().
  Restriction(const amr::Forest& forest, double curvature);

  /// Asks for the sums along the normals of `faces`.
  void request(const std::vector<RimFace>& faces, LayerSums<S>& sums);
  /// Fills the part of the parent's rim in the field of its level, once the rows of the leaf have been summed.
  void write(int leaf, const std::vector<RimFace>& faces, const Conversion& conversion, MomentField<S>& coarse) const;

 private:
  using Real = typename S::Real;

  void write_face(int leaf, const RimFace& rim, const Conversion& conversion, MomentField<S>& coarse) const;

  const amr::Forest& forest_;
  const Axis axis_;
  const double curvature_;
  const Stencil<Real> stencil_;
  // of two lines along themselves at once, eight cells of each
  std::array<IndexVec<Real>, restriction_taps> lane_;
  std::array<std::array<Vec<Real>, restriction_taps>, 2> lane_weight_;
  std::array<Plane<S>, 6> sum_;  // by face
};

}  // namespace drogue::lbm
