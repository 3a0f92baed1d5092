// SPDX-License-Identifier: GPL-3.0-or-later
// Fourth-order restriction of fine leaves onto the rim of the parent that covers them, two layers deep: one is streamed
// from, both are in reach of the cubic interpolation. The stencils stay inside a leaf, so its rim is summed up while it
// is updated and nothing is read again.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "lbm/lines.hpp"

namespace drogue::lbm {

/// A face of a leaf whose cells a parent needs.
struct RimFace {
  int face;        ///< 0 to 5
  bool also_rows;  ///< of an x face: write the rows of the parent as well as its columns
};

/// Those of each leaf of a level.
struct RestrictionPlan {
  int first_leaf = 0;
  std::vector<std::vector<RimFace>> faces;

  std::span<const RimFace> faces_of(int leaf) const { return faces[leaf - first_leaf]; }
};

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

}  // namespace drogue::lbm
