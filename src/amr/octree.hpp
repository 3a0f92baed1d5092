// SPDX-License-Identifier: GPL-3.0-or-later
// The octree behind the forest: p4est refines and balances it, and hands back its leaves.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/types.hpp"

namespace drogue::amr {

inline constexpr int deepest_level = 18;  ///< p4est keeps a leaf's place in a tree in 19 bits

inline constexpr std::int64_t most_blocks = 1 << 22;  ///< a terabyte of cells

struct Leaf {
  int level;
  Index3 index;  ///< block coordinates within the level
};

/// Should the block of `level` at `index` be refined?
using RefineBlock = std::function<bool(int level, const Index3& index)>;

/// Leaves in Morton order of a brick of `trees` trees, refined where asked and to at most `finest_level`, then 2:1
/// balanced across faces, edges and corners, periodic ones included. What `refine` throws is passed on. Throws
/// InputError beyond `most_blocks`.
std::vector<Leaf> balanced_leaves(const Index3& trees, const std::array<bool, 3>& periodic, int finest_level,
                                  const RefineBlock& refine);

}  // namespace drogue::amr
