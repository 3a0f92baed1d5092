// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/interpolation.hpp"

#include "lbm/level_transfer.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

}  // namespace

template <class S>
Interpolation<S>::Interpolation(const amr::Forest& forest, int level)
    : forest_(forest),
      plan_(plan_interpolation(forest, level)),
      stencil_{Stencil<Real>(axis_of_rule(0)), Stencil<Real>(axis_of_rule(1)), Stencil<Real>(axis_of_rule(2)),
               Stencil<Real>(axis_of_rule(3))},
      present_(plan_.sum.size()),
      half_way_(plan_.sum.size()) {}

template <class S>
void Interpolation<S>::combine(const LayerSum& sum, const MomentField<S>& field, bool mean, Plane& plane) const {
  using Layout = RowLayout<S>;
  for (int i = sum.lines.begin; i < sum.lines.end; ++i) {
    std::array<const std::byte*, interpolation_taps> line;
    for (int k = 0; k < sum.taps; ++k) line[k] = line_of(field, sum.block, sum.normal, sum.first_layer + k, i);
    for (int m = 0; m < moments; ++m) {
      Vec<Real> v{};
      for (int k = 0; k < sum.taps; ++k) v += static_cast<Real>(sum.weight[k]) * Layout::load_scaled(line[k], m);
      plane[i][m] = mean ? Real(0.5) * (plane[i][m] + v) : v;
    }
  }
}

template <class S>
void Interpolation<S>::take(const MomentField<S>& coarse, Time time) {
  std::vector<Plane>& to = time == Time::present ? present_ : half_way_;
  const int count = static_cast<int>(plan_.sum.size());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < count; ++i) {
    const LayerSum& sum = plan_.sum[i];
    const bool mean = time == Time::half_way && forest_.block(sum.block).kind == amr::Kind::leaf;
    if (mean) to[i] = present_[i];
    combine(sum, coarse, mean, to[i]);
  }
  taken_ = time;
}

template <class S>
void Interpolation<S>::take_present(const MomentField<S>& coarse) {
  take(coarse, Time::present);
}

template <class S>
void Interpolation<S>::take_half_way(const MomentField<S>& coarse_end) {
  take(coarse_end, Time::half_way);
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
  const std::vector<Plane>& plane = taken_ == Time::present ? present_ : half_way_;
  const auto term = [&](const std::array<int, 2>& sums, int line, int m) -> V {
    const V v = plane[sums[0]][line][m];
    return sums[1] == amr::none ? v : v + plane[sums[1]][line][m];
  };
  V combined[n][moments];
  for (int i = first; i < end; ++i)
    for (int m = 0; m < moments; ++m) {
      const V low = term(job.sum[i / n][0], i % n, m), high = term(job.sum[i / n][1], i % n, m);
      V v = along.lane_weight[0] * pick<Real>(low, high, along.lane[0]);
      for (int k = 1; k < taps; ++k) v += along.lane_weight[k] * pick<Real>(low, high, along.lane[k]);
      combined[i - first][m] = v;
    }
  const IndexVec<Real> wanted = (lane_numbers<Real> >= job.cells.begin) & (lane_numbers<Real> < job.cells.end);
  const bool whole = job.cells.begin == 0 && job.cells.end == n;
  for (int i = job.lines.begin; i < job.lines.end; ++i) {
    std::byte* to = line_of(fine, job.target, job.normal, job.layer, i);
    const auto* from = combined + across.start[i] - first;
    for (int m = 0; m < moments; ++m) {
      V v = across.weight[i][0] * from[0][m];
      for (int k = 1; k < taps; ++k) v += across.weight[i][k] * from[k][m];
      v = static_cast<Real>(conversion.factor(m)) * v + static_cast<Real>(conversion.shift(m));
      Layout::store_scaled(to, m, whole ? v : wanted ? v : Layout::load_scaled(to, m));
    }
    copy_line(fine, job.target, job.normal, job.layer, i, job.cells, job.also_rows);
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
