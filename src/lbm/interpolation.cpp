// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/interpolation.hpp"

#include <memory>

#include "lbm/level_transfer.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

}  // namespace

template <class S>
Interpolation<S>::Interpolation(const amr::Forest& forest, int level, double curvature)
    : plan_(plan_interpolation(forest, level)),
      curvature_(curvature),
      leaf_weight_(static_cast<Real>(joint_stencil().leaf_weight)),
      stencil_{Stencil<Real>(axis_of_rule(0), curvature), Stencil<Real>(axis_of_rule(1), curvature),
               Stencil<Real>(axis_of_rule(2), curvature), Stencil<Real>(axis_of_rule(3), curvature)},
      of_leaf_(forest, level - 1),
      plane_{HugeVector<Plane<S>>(plan_.sum.size()), HugeVector<Plane<S>>(plan_.sum.size())} {
  for (std::size_t i = 0; i < plan_.sum.size(); ++i) of_leaf_[plan_.sum[i].leaf].push_back(static_cast<int>(i));
}

/// From the rows of a leaf, as in the course of an update.
template <class S>
void Interpolation<S>::take(const LeafSum& sum, const MomentField<S>& field, Plane<S>& plane) const {
  const auto sums = std::make_unique_for_overwrite<LayerSums<S>>();
  sums->request(sum.sum, curvature_, plane);
  sums->sum(field.block(sum.leaf));
}

template <class S>
void Interpolation<S>::request(int leaf, LayerSums<S>& sums) {
  for (const int i : of_leaf_[leaf]) sums.request(plan_.sum[i].sum, curvature_, plane_[1 - now_][i]);
}

template <class S>
template <class F>
void Interpolation<S>::for_each_sum(const F& f) const {
  const int count = static_cast<int>(plan_.sum.size());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < count; ++i) f(plan_.sum[i], i);
}

template <class S>
void Interpolation<S>::start(const MomentField<S>& coarse) {
  for_each_sum([&](const LeafSum& sum, int i) { take(sum, coarse, plane_[now_][i]); });
}

template <class S>
void Interpolation<S>::take_half_way(const MomentField<S>& coarse_end) {
  for_each_sum([&](const LeafSum& sum, int i) {
    Plane<S>&now = plane_[now_][i], &end = plane_[1 - now_][i];
    if (coarse_end.changed(sum.leaf)) take(sum, coarse_end, end);
    for (int line = sum.lines.begin; line < sum.lines.end; ++line)
      for (int m = 0; m < moments; ++m) now[line][m] = Real(0.5) * (now[line][m] + end[line][m]);
  });
}

/// Lines are combined along themselves first, then across. Flattened, or GCC 12 passes vectors through memory from call
/// to call.
template <class S>
[[gnu::flatten]] void Interpolation<S>::fill(const RimJob& job, const Conversion& conversion,
                                             MomentField<S>& fine) const {
  using Layout = RowLayout<S>;
  using V = Vec<Real>;
  constexpr int taps = interpolation_taps;
  const Stencil<Real>&across = stencil_[job.across_rule], &along = stencil_[job.along_rule];
  const int first = across.start[job.lines.begin], end = across.start[job.lines.end - 1] + taps;
  const auto term = [&](const std::array<int, 2>& sums, int line, int m) -> V {
    const V v = plane_[now_][sums[0]][line][m];
    return sums[1] == amr::none ? v : v + plane_[now_][sums[1]][line][m];
  };
  V combined[n][moments];
  for (int i = first; i < end; ++i)
    for (int m = 0; m < moments; ++m) {
      const V low = term(job.sum[i / n][0], i % n, m), high = term(job.sum[i / n][1], i % n, m);
      const auto& weight = along.lane_weight[is_curved(m, along_axis(job.normal))];
      V v = weight[0] * pick<Real>(low, high, along.lane[0]);
      for (int k = 1; k < taps; ++k) v += weight[k] * pick<Real>(low, high, along.lane[k]);
      combined[i - first][m] = v;
    }
  const bool is_joint = job.beside != amr::none;
  const Real leaf_weight = is_joint ? leaf_weight_ : Real(0);
  const MomentConversion<Real> convert(conversion, Real(1) - leaf_weight);
  const IndexVec<Real> wanted = (lane_numbers<Real> >= job.cells.begin) & (lane_numbers<Real> < job.cells.end);
  const bool whole = job.cells.begin == 0 && job.cells.end == n;
  for (int i = job.lines.begin; i < job.lines.end; ++i) {
    std::byte* to = fine.line(job.target, job.normal, job.layer, i);
    const std::byte* leaf = is_joint ? fine.line(job.beside, job.normal, n - 1 - job.layer, i) : nullptr;
    const auto* from = combined + across.start[i] - first;
#pragma GCC unroll 10
    for (int m = 0; m < moments; ++m) {
      const auto& weight = across.weight[i][is_curved(m, across_axis(job.normal))];
      V v = weight[0] * from[0][m];
      for (int k = 1; k < taps; ++k) v += weight[k] * from[k][m];
      v = convert.factor[m] * v + convert.shift[m];
      if (is_joint) v += leaf_weight * Layout::load_scaled(leaf, m);
      Layout::store_scaled(to, m, whole ? v : wanted ? v : Layout::load_scaled(to, m));
    }
    if (job.copy) copy_line(fine, job.target, job.normal, job.layer, i, job.cells);
  }
}

template <class S>
void Interpolation<S>::fill_rims(const Conversion& conversion, MomentField<S>& fine) const {
  const int targets = static_cast<int>(plan_.first.size()) - 1;
#pragma omp parallel for schedule(dynamic, 4)
  for (int i = 0; i < targets; ++i)
    for (int j = plan_.first[i]; j < plan_.first[i + 1]; ++j) fill(plan_.job[j], conversion, fine);
}

#ifdef __F16C__
template class Interpolation<HalfStress>;
#endif
template class Interpolation<FloatStress>;
template class Interpolation<DoubleStress>;

}  // namespace drogue::lbm
