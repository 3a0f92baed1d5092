// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/restriction.hpp"

#include <algorithm>

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size, half = n / 2, taps = restriction_taps;

}  // namespace

template <class S>
Restriction<S>::Restriction(const amr::Forest& forest, double curvature)
    : forest_(forest), axis_(restriction_axis()), curvature_(curvature), stencil_(axis_, curvature) {
  const IndexVec<Real> second_line = lane_numbers<Real> >= half ? IndexVec<Real>{} + n : IndexVec<Real>{};
  for (int k = 0; k < taps; ++k) {
    for (int i = 0; i < n; ++i) {
      lane_[k][i] = stencil_.start[i % half] + k;
      for (const bool curved : {false, true}) lane_weight_[curved][k][i] = stencil_.weight[i % half][curved][k];
    }
    lane_[k] += second_line;
  }
}

template <class S>
void Restriction<S>::request(const std::vector<RimFace>& faces, LayerSums<S>& sums) {
  for (const RimFace& rim : faces) {
    const int output = rim.face & 1 ? half - 1 : 0;  // of one child
    sums.request({rim.face / 2, axis_.start[output], taps, axis_.weight[output], axis_.curvature[output]}, curvature_,
                 sum_[rim.face]);
  }
}

/// Across first; then two lines along themselves at once, whose eight cells each fill a vector.
template <class S>
void Restriction<S>::write_face(int leaf_id, const RimFace& rim, const Conversion& conversion,
                                MomentField<S>& coarse) const {
  using Layout = RowLayout<S>;
  using V = Vec<Real>;
  const amr::Block& leaf = forest_.block(leaf_id);
  const int normal = rim.face / 2, layer = rim.face & 1 ? n - 1 : 0;
  const int across_half = leaf.index[across_axis(normal)] & 1, along_half = leaf.index[along_axis(normal)] & 1;
  const Range cells{along_half * half, along_half * half + half};
  const auto& sum = sum_[rim.face];
  const MomentConversion<Real> convert(conversion);
  for (int i = 0; i < half; i += 2) {
    const int line = across_half * half + i;
#pragma GCC unroll 10
    for (int m = 0; m < moments; ++m) {
      V across[2];
      for (int j = 0; j < 2; ++j) {
        const auto& weight = stencil_.weight[i + j][is_curved(m, across_axis(normal))];
        const auto* from = &sum[stencil_.start[i + j]];
        across[j] = weight[0] * from[0][m];
        for (int k = 1; k < taps; ++k) across[j] += weight[k] * from[k][m];
      }
      const auto& lane_weight = lane_weight_[is_curved(m, along_axis(normal))];
      V v = lane_weight[0] * pick<Real>(across[0], across[1], lane_[0]);
      for (int k = 1; k < taps; ++k) v += lane_weight[k] * pick<Real>(across[0], across[1], lane_[k]);
      v = convert.factor[m] * v + convert.shift[m];
      Layout::store_half_scaled(coarse.line(leaf.parent, normal, layer, line), m, along_half, low_half<Real>(v));
      Layout::store_half_scaled(coarse.line(leaf.parent, normal, layer, line + 1), m, along_half, high_half<Real>(v));
    }
    if (!rim.copy) continue;
    for (int j = 0; j < 2; ++j) copy_line(coarse, leaf.parent, normal, layer, line + j, cells);
  }
}

template <class S>
void Restriction<S>::write(int leaf, const std::vector<RimFace>& faces, const Conversion& conversion,
                           MomentField<S>& coarse) const {
  for (const RimFace& rim : faces) write_face(leaf, rim, conversion, coarse);
}

#ifdef __F16C__
template class Restriction<HalfStress>;
#endif
template class Restriction<FloatStress>;
template class Restriction<DoubleStress>;

}  // namespace drogue::lbm
