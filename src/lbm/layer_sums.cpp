// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/layer_sums.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size, half = n / 2;

}  // namespace

template <class S>
void LayerSums<S>::request(const LayerSum& sum, double curvature, Plane<S>& result) {
  requests_.push_back(
      {sum.normal, sum.first, sum.taps, moment_weights<Real>(sum.weight, sum.curvature, curvature), &result});
  const unsigned layers = ((1u << sum.taps) - 1) << sum.first;
  if (sum.normal == 0) sides_[sum.first / half] = true;
  if (sum.normal == 1) y_rows_ |= layers;
  if (sum.normal == 2) z_rows_ |= layers;
}

template <class S>
void LayerSums<S>::sum_columns(int side, int z) {
  for (int m = 0; m < moments; ++m) {
    const auto columns = end_[side].columns(m);
    const auto stored = [&](int x) { return m < pxx ? columns[x % half] : S::as_stored(columns[x % half]); };
    for (const Request& r : requests_) {
      if (r.normal != 0 || r.first / half != side) continue;
      const auto& weight = r.weight[is_curved(m, 0)];
      Vec<Real> sum = weight[0] * stored(r.first);
      for (int k = 1; k < r.taps; ++k) sum += weight[k] * stored(r.first + k);
      (*r.result)[z][m] = sum;
    }
  }
}

template <class S>
void LayerSums<S>::sum_rows(const std::byte* rows) {
  for (const Request& r : requests_) {
    if (r.normal == 0) continue;
    for (int line = 0; line < n; ++line) {
      const std::byte* row = rows + (r.normal == 1 ? line * n + r.first : r.first * n + line) * Layout::bytes;
      const std::size_t stride = (r.normal == 1 ? 1 : n) * Layout::bytes;
      for (int m = 0; m < moments; ++m) {
        const auto& weight = r.weight[is_curved(m, r.normal)];
        Vec<Real> sum = weight[0] * Layout::load_scaled(row, m);
        for (int k = 1; k < r.taps; ++k) sum += weight[k] * Layout::load_scaled(row + k * stride, m);
        (*r.result)[line][m] = sum;
      }
    }
  }
}

template <class S>
void LayerSums<S>::sum(const std::byte* rows) {
  for (int side = 0; side < 2; ++side)
    for (int i = 0; sides_[side] && i < rows_per_block; ++i)
      add_end(side, Layout::load_row(rows + i * Layout::bytes), i % n, i / n);
  sum_rows(rows);
}

#ifdef __F16C__
template class LayerSums<HalfStress>;
#endif
template class LayerSums<FloatStress>;
template class LayerSums<DoubleStress>;

}  // namespace drogue::lbm
