// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/restriction.hpp"

#include <algorithm>

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size, half = n / 2, taps = restriction_taps;

}  // namespace

template <class S>
void Restriction<S>::begin(int leaf, std::span<const RimFace> faces) {
  leaf_ = leaf;
  faces_ = faces;
  wanted_.fill(false);
  y_rows_ = z_rows_ = 0;
  for (const RimFace& rim : faces) {
    wanted_[rim.face] = true;
    const unsigned rows = ((1u << taps) - 1) << (rim.face & 1 ? n - taps : 0);
    if (rim.face / 2 == 1) y_rows_ |= rows;
    if (rim.face / 2 == 2) z_rows_ |= rows;
  }
  x_faces_ = wanted_[0] || wanted_[1];
}

template <class S>
void Restriction<S>::add_columns(int side, int z) {
  for (int m = 0; m < moments; ++m) {
    const auto columns = end_[side].columns(m);
    for (int r = 0; r < layers; ++r) {
      const auto& weight = stencil_.weight[output_of(side, r)];
      Vec<Real> sum{};
      for (int k = 0; k < taps; ++k) sum += weight[k] * columns[side ? RowEnd<Real>::depth - taps + k : k];
      sum_[side][z][r][m] = sum;
    }
  }
}

/// Across first; then both layers along themselves at once, whose eight cells each fill a vector.
template <class S>
void Restriction<S>::write_face(const RimFace& rim, const Conversion& conversion, MomentField<S>& coarse) const {
  using Layout = RowLayout<S>;
  using V = Vec<Real>;
  const amr::Block& leaf = forest_.block(leaf_);
  const int normal = rim.face / 2, side = rim.face & 1;
  const int across_half = leaf.index[across_axis(normal)] & 1, along_half = leaf.index[along_axis(normal)] & 1;
  const Range cells{along_half * half, along_half * half + half};
  const auto& lines = sum_[rim.face];
  const MomentConversion<Real> convert(conversion);
  const IndexVec<Real> second_layer = lane_numbers<Real> >= half ? IndexVec<Real>{} + n : IndexVec<Real>{};
  std::array<IndexVec<Real>, taps> lane;
  std::array<V, taps> lane_weight;
  for (int k = 0; k < taps; ++k) {
    for (int i = 0; i < n; ++i) {
      lane[k][i] = stencil_.start[i % half] + k;
      lane_weight[k][i] = stencil_.weight[i % half][k];
    }
    lane[k] += second_layer;
  }
  for (int i = 0; i < half; ++i) {
    const int line = across_half * half + i;
    std::array<std::byte*, layers> to;
    for (int r = 0; r < layers; ++r)
      to[r] = line_of(coarse, leaf.parent, normal, (side ? n - layers : 0) + r, line);
    const auto* from = &lines[stencil_.start[i]];
#pragma GCC unroll 10
    for (int m = 0; m < moments; ++m) {
      V across[layers];
      for (int r = 0; r < layers; ++r) {
        across[r] = stencil_.weight[i][0] * from[0][r][m];
        for (int k = 1; k < taps; ++k) across[r] += stencil_.weight[i][k] * from[k][r][m];
      }
      V v = lane_weight[0] * pick<Real>(across[0], across[1], lane[0]);
      for (int k = 1; k < taps; ++k) v += lane_weight[k] * pick<Real>(across[0], across[1], lane[k]);
      v = convert.factor[m] * v + convert.shift[m];
      Layout::store_half_scaled(to[0], m, along_half, low_half<Real>(v));
      Layout::store_half_scaled(to[1], m, along_half, high_half<Real>(v));
    }
    if (!rim.copy) continue;
    for (int r = 0; r < layers; ++r) copy_line(coarse, leaf.parent, normal, (side ? n - layers : 0) + r, line, cells);
  }
}

template <class S>
void Restriction<S>::write(const Conversion& conversion, MomentField<S>& coarse) const {
  for (const RimFace& rim : faces_) write_face(rim, conversion, coarse);
}

template <class S>
void Restriction<S>::restrict_stored(const MomentField<S>& fine, int leaf, std::span<const RimFace> faces,
                                     const Conversion& conversion, MomentField<S>& coarse) {
  begin(leaf, faces);
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      if (wants(y, z)) add(RowLayout<S>::load_row(fine.row(leaf, y, z)), y, z);
  write(conversion, coarse);
}

#ifdef __F16C__
template class Restriction<HalfStress>;
#endif
template class Restriction<FloatStress>;
template class Restriction<DoubleStress>;

}  // namespace drogue::lbm
