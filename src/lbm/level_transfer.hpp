// SPDX-License-Identifier: GPL-3.0-or-later
// Which cells of which blocks the transfer between levels must fill so that every leaf finds its neighbourhood on its
// own level.
#pragma once

#include <cstdint>
#include <vector>

#include "lbm/interpolation.hpp"
#include "lbm/restriction.hpp"

namespace drogue::lbm {

/// Rims of the ghosts of `level` that touch a leaf across a face or an edge, from their hosts on `level` - 1 and, at
/// faces, from that leaf. (No population crosses a corner.) Rims at y and z faces are rows, those at z faces with their
/// ends as columns; rims at x faces are columns, also written as rows where a boundary block mirrors them.
InterpolationPlan plan_interpolation(const amr::Forest& forest, int level);

/// Of the leaves of `level`, the faces under the layer of their parents that lies against leaves of `level` - 1. Rows
/// and columns as above.
RestrictionPlan plan_restriction(const amr::Forest& forest, int level);

/// Whether the line of 16 cells of a block from `first` along an axis, which its neighbour beyond a face or edge
/// streams from, is kept in columns.
bool is_in_columns(const amr::Forest& forest, int id, const Index3& first, int along);

/// Of every leaf, which neighbours beside it along x it streams from in columns; bits by amr::neighbour_slot.
std::vector<std::uint32_t> columns_beside(const amr::Forest& forest);

/// Whether the rim of a ghost or parent along the edge towards an offset in x and y is to be found in rows: where a y
/// face alone brings it about.
bool edge_is_in_rows(const amr::Forest& forest, int id, const Index3& towards);

}  // namespace drogue::lbm
