// SPDX-License-Identifier: GPL-3.0-or-later
// Fourth-order restriction of fine leaves onto the rim of the parent that covers them, two layers deep: one is streamed
// from, both are in reach of the cubic interpolation. The stencils stay inside a leaf, so its rim is summed up while it
// is updated and nothing is read again.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "lbm/by_leaf.hpp"
#include "lbm/lines.hpp"

namespace drogue::lbm {

/// A face of a leaf whose cells a parent needs.
struct RimFace {
  int face;   ///< 0 to 5
  bool copy;  ///< the lines of the parent, see copy_line()
};

using RestrictionPlan = ByLeaf<RimFace>;

/// Restricts one leaf at a time: begin(), add() for all rows of each plane in turn, write(). About 140 KB.
template <class S>
class Restriction {
 public:
  using Real = typename S::Real;
  static constexpr int layers = 2;

  explicit Restriction(const amr::Forest& forest) : forest_(forest), stencil_(restriction_axis()) {}

  void begin(int leaf, std::span<const RimFace> faces);
  bool wants(int y, int z) const { return x_faces_ || (y_rows_ >> y & 1) || (z_rows_ >> z & 1); }
  void add(const Row<Real>& row, int y, int z);
  /// Fills the part of the parent's rim in the field of its level.
  void write(const Conversion& conversion, MomentField<S>& coarse) const;
  /// All of these with rows that are read again.
  void restrict_stored(const MomentField<S>& fine, int leaf, std::span<const RimFace> faces,
                       const Conversion& conversion, MomentField<S>& coarse);

 private:
  using Line = std::array<Vec<Real>, moments>;
  using Lines = std::array<Line, layers>;

  /// Which tap of the stencils at a face a layer is, 0 to taps - 1, or another number.
  static constexpr int tap_of(int side, int layer) {
    return side ? layer - (amr::block_size - restriction_taps) : layer;
  }
  /// Of a child: the output, 0 to 7, that is layer `r` of the rim at a face.
  static constexpr int output_of(int side, int r) { return side ? amr::block_size / 2 - layers + r : r; }

  void accumulate(int face, int line, int layer, const Line& values);
  void add_columns(int side, int z);
  void write_face(const RimFace& rim, const Conversion& conversion, MomentField<S>& coarse) const;

  const amr::Forest& forest_;
  const Stencil<Real> stencil_;
  int leaf_ = amr::none;
  std::span<const RimFace> faces_;
  std::array<bool, 6> wanted_{};
  bool x_faces_ = false;
  unsigned y_rows_ = 0, z_rows_ = 0;                         // bits of the y and z that are summed
  std::array<RowEnd<Real>, 2> end_{RowEnd<Real>(0), RowEnd<Real>(1)};
  std::array<std::array<Lines, amr::block_size>, 6> sum_;  // [face][line]
};

/// Adds a layer of a line to the sums, which its first one starts.
template <class S>
[[gnu::always_inline]] inline void Restriction<S>::accumulate(int face, int line, int layer, const Line& values) {
  const int side = face & 1, k = tap_of(side, layer);
  if (k < 0 || k >= restriction_taps) return;
  for (int r = 0; r < layers; ++r) {
    const Real weight = stencil_.weight[output_of(side, r)][k];
    Line& sum = sum_[face][line][r];
    for (int m = 0; m < moments; ++m) sum[m] = k == 0 ? weight * values[m] : sum[m] + weight * values[m];
  }
}

template <class S>
[[gnu::always_inline]] inline void Restriction<S>::add(const Row<Real>& row, int y, int z) {
  Line stored = row.m;
  for (int m = pxx; m < moments; ++m) stored[m] = S::as_stored(row.m[m]);
  for (int side = 0; side < 2; ++side) {
    if (wanted_[2 + side]) accumulate(2 + side, z, y, stored);
    if (wanted_[4 + side]) accumulate(4 + side, y, z, stored);
    if (!wanted_[side]) continue;
    for (int m = 0; m < moments; ++m) end_[side].put(m, y, stored[m]);
    if (y == amr::block_size - 1) add_columns(side, z);
  }
}

}  // namespace drogue::lbm
