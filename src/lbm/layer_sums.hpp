// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over layers of a block along the normal of a rim: the first stage of both transfers between levels. Those of
// leaves are taken while the leaf is updated and its rows are in registers, so that nothing is read again.
#pragma once

#include <array>
#include <vector>

#include "lbm/lines.hpp"
#include "lbm/moments.hpp"

namespace drogue::lbm {

/// `taps` layers from `first` along `normal` (0 x, 1 y, 2 z), weighted.
struct LayerSum {
  int normal, first, taps;
  Axis::Weights weight, curvature;

  bool operator==(const LayerSum&) const = default;
};

/// A layer in 16 lines of 16 cells (lbm/lines.hpp); stresses as the storage scales them.
template <class S>
using Plane = std::array<std::array<Vec<typename S::Real>, moments>, amr::block_size>;

/// The eight cells at one end of the rows of a plane, to be read as columns along y.
template <class Real>
class RowEnd {
 public:
  static constexpr int depth = lanes / 2;

  /// `side` 0: x = 0 to 7, 1: x = 8 to 15.
  void put(int side, int m, int y, Vec<Real> row) {
    store_unaligned<Real>(end_[m][y % depth] + y / depth * depth, side ? high_half<Real>(row) : low_half<Real>(row));
  }

  /// Columns of moment m along y, in the order of x.
  std::array<Vec<Real>, depth> columns(int m) const {
    std::array<Vec<Real>, depth> v;
    for (int i = 0; i < depth; ++i) v[i] = load<Real>(end_[m][i]);
    // vector i, lane (j, k) holds row i + 8 j and cell k: exchange i and k bit by bit
    for (int bit = depth / 2; bit > 0; bit /= 2)
      for (int i = 0; i < depth; ++i)
        if (!(i & bit)) exchange<Real>(v[i], v[i | bit], bit);
    return v;
  }

 private:
  alignas(128) Real end_[moments][depth][lanes];
};

/// Takes sums of one block at a time: begin(), request() for each, then add() for the rows that it wants, plane by
/// plane, and finish(); or, of a block in memory, sum(). While a block is updated its rows are only put aside, because
/// the update itself needs the first-level cache. About 130 KB.
template <class S>
class LayerSums {
 public:
  using Real = typename S::Real;

  void begin() {
    requests_.clear();
    sides_ = {false, false};
    y_rows_ = z_rows_ = 0;
  }
  /// Sums along x must lie in one half of the block. To moments that is_curved() `curvature` times that is added.
  void request(const LayerSum& sum, double curvature, Plane<S>& result);
  bool empty() const { return requests_.empty(); }

  bool wants(int y, int z) const { return sides_[0] || sides_[1] || wants_row(y, z); }
  [[gnu::always_inline]] inline void add(const Row<Real>& row, int y, int z);
  void finish() { sum_rows(rows_.data()); }
  void sum(const std::byte* rows);

 private:
  using Layout = RowLayout<S>;
  struct Request {
    int normal, first, taps;
    MomentWeights<Real> weight;
    Plane<S>* result;
  };
  bool wants_row(int y, int z) const { return (y_rows_ >> y & 1) || (z_rows_ >> z & 1); }
  void add_end(int side, const Row<Real>& row, int y, int z);
  void sum_columns(int side, int z);
  void sum_rows(const std::byte* rows);

  std::vector<Request> requests_;
  std::array<bool, 2> sides_{};       // of which there are sums along x
  unsigned y_rows_ = 0, z_rows_ = 0;  // bits of the layers that are summed
  std::array<RowEnd<Real>, 2> end_;
  alignas(64) std::array<std::byte, Layout::block_bytes> rows_;  // those put aside
};

template <class S>
void LayerSums<S>::add(const Row<Real>& row, int y, int z) {
  if (wants_row(y, z)) Layout::store_row(rows_.data() + (z * lanes + y) * Layout::bytes, row);
  for (int side = 0; side < 2; ++side)
    if (sides_[side]) add_end(side, row, y, z);
}

template <class S>
inline void LayerSums<S>::add_end(int side, const Row<Real>& row, int y, int z) {
  for (int m = 0; m < moments; ++m) end_[side].put(side, m, y, row.m[m]);
  if (y == lanes - 1) sum_columns(side, z);
}

}  // namespace drogue::lbm
