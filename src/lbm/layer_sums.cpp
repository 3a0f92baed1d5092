// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/layer_sums.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size, half = n / 2;

}  // namespace

template <class S>
void LayerSums<S>::request(const LayerSum& sum, Plane<S>& result) {
  Request request{sum.normal, sum.first, sum.taps, {}, &result};
  for (int k = 0; k < sum.taps; ++k) request.weight[k] = static_cast<Real>(sum.weight[k]);
  requests_.push_back(request);
  const unsigned layers = ((1u << sum.taps) - 1) << sum.first;
  if (sum.normal == 0) sides_[sum.first / half] = true;
  if (sum.normal == 1) y_rows_ |= layers;
  if (sum.normal == 2) z_rows_ |= layers;
}

template <class S>
void LayerSums<S>::add_columns(int side, int z) {
  for (int m = 0; m < moments; ++m) {
    const auto columns = end_[side].columns(m);
    for (const Request& r : requests_) {
      if (r.normal != 0 || r.first / half != side) continue;
      Vec<Real> sum = r.weight[0] * columns[r.first % half];
      for (int k = 1; k < r.taps; ++k) sum += r.weight[k] * columns[r.first % half + k];
      (*r.result)[z][m] = sum;
    }
  }
}

template <class S>
void LayerSums<S>::add_block(const std::byte* rows) {
  using Layout = RowLayout<S>;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      if (wants(y, z)) add(Layout::load_row(rows + (z * n + y) * Layout::bytes), y, z);
}

#ifdef __F16C__
template class LayerSums<HalfStress>;
#endif
template class LayerSums<FloatStress>;
template class LayerSums<DoubleStress>;

}  // namespace drogue::lbm
