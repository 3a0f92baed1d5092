// SPDX-License-Identifier: GPL-3.0-or-later
// How the immersed boundary sees the finest level of a fluid without knowing which fluid it is.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "amr/forest.hpp"

namespace drogue::fluid {

/// Cell-centred velocity of one level, valid during one hook call. Component a of cell (i, j, k) of block b is
/// `scale * block(b)[k * stride_z + j * stride_y + a * stride_component + i]` [m/s]. Leaves only.
struct VelocityView {
  const amr::Forest* forest;
  const float* const* base;  ///< per block id; null where the block is not a leaf of the finest level
  std::ptrdiff_t stride_component, stride_y, stride_z;
  float scale;

  const float* block(int id) const { return base[id]; }
};

/// Force per volume [N/m^3] on the finest level; exists only in blocks that were opened, array [z][y][component][x].
class ForceField {
 public:
  static constexpr int stride_component = amr::block_size;
  static constexpr int stride_y = 3 * amr::block_size;
  static constexpr int stride_z = 3 * amr::block_size * amr::block_size;
  static constexpr int block_floats = 3 * amr::block_cells;

  explicit ForceField(const amr::Forest& forest) : slot_(forest.size(), amr::none) {}

  /// Makes zeroed force arrays for these finest leaves; those opened before are kept. Not thread safe.
  void open(std::span<const int> blocks);
  /// The array of an opened block; null otherwise. Distinct blocks may be written by distinct threads.
  float* block(int id) { return slot_[id] == amr::none ? nullptr : storage_[slot_[id]].get(); }
  const float* block(int id) const { return slot_[id] == amr::none ? nullptr : storage_[slot_[id]].get(); }
  std::span<const int> opened() const { return opened_; }
  /// Closes every block; memory is kept for the next step.
  void clear();

  /// Calls f(r, row) for the rows of an opened block that hold a force, r = 16 z + y, and empties them, so that they
  /// need not be zeroed when the block is opened again. Distinct blocks may be drained by distinct threads.
  template <class F>
  void drain(int id, const F& f) {
    float* row = block(id);
    for (int r = 0; r < amr::block_size * amr::block_size; ++r, row += stride_y) {
      std::uint32_t bits = 0;  // comparisons would not be vectorised
      for (int i = 0; i < stride_y; ++i) bits |= std::bit_cast<std::uint32_t>(row[i]);
      if (bits == 0) continue;
      f(r, std::as_const(row));
      std::fill_n(row, stride_y, 0.0f);
    }
    is_zero_[slot_[id]] = true;
  }

 private:
  std::vector<int> slot_;    // block id -> storage
  std::vector<int> opened_;  // block ids, in the order of their storage
  std::vector<std::unique_ptr<float[]>> storage_;
  std::vector<std::uint8_t> is_zero_;  // by storage
};

}  // namespace drogue::fluid
