// SPDX-License-Identifier: GPL-3.0-or-later
// Where the cells of two levels meet, for counting the mass that crosses (lbm/reflux.hpp). A coarse leaf with fine
// leaves beyond one of its faces is a host: it holds ghosts of the fine level and has parents beside it. On either
// level, one side of the interface is the `inner` one, that of the hosts (coarse leaves, and the ghosts in them), the
// other the `outer` one (parents, and the fine leaves they stand for).
#pragma once

#include <array>

#include "fluid/specification.hpp"
#include "lbm/by_leaf.hpp"

namespace drogue::lbm {

/// Two blocks of one level, inner and outer, with a face of the interface between them.
struct InterfaceFace {
  int inner, outer;
  int face;                  ///< 0 to 5, of the inner block
  std::array<bool, 4> open;  ///< ends at an open boundary: low and high along lines, then across them (lbm/lines.hpp)
};

/// A line of 16 cells of a block, from `first` along an axis, whose populations of one diagonal direction add to the
/// mass of the inner side with this weight, because they do not go the way that the sums over faces count.
struct DiagonalTerm {
  int block, along, weight;
  Index3 first, direction;
  bool in_columns;  ///< MomentField::load_line()
};

/// What crosses between two levels, as one of them sees it; by a leaf that is beside it.
struct InterfaceSide {
  ByLeaf<InterfaceFace> faces;
  ByLeaf<DiagonalTerm> diagonals;
};

struct Interface {
  InterfaceSide coarse, fine;
};

/// The interface between `coarse` and `coarse` + 1.
Interface plan_interface(const amr::Forest& forest, const fluid::Specification& specification, int coarse);

}  // namespace drogue::lbm
