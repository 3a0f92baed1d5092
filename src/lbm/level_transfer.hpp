// SPDX-License-Identifier: GPL-3.0-or-later
// Which boxes of which blocks must be resampled so that every leaf finds its neighbourhood on its own level.
#pragma once

#include <vector>

#include "lbm/resample.hpp"

namespace drogue::lbm {

/// Jobs sorted by target; `first[i]` .. `first[i + 1]` share the i-th target, so targets may be filled in parallel.
struct TransferPlan {
  std::vector<ResampleJob> job;
  std::vector<int> first;
};

/// Rims of the ghosts of `level` that touch a leaf across a face or an edge, from their hosts on `level` - 1. (No
/// population crosses a corner.) Rims at y and z faces are rows, with their ends as columns; rims at x faces are
/// columns, also written as rows where a boundary block mirrors them.
TransferPlan plan_interpolation(const amr::Forest& forest, int level);

/// The two layers of the parents of `level` that lie against leaves, from their children on `level` + 1: one is
/// streamed from, both are in reach of the cubic interpolation. Rows and columns as above; rims at x faces are also
/// written as rows where the interpolation of a y or z face reads across them (concave edges of the fine region).
TransferPlan plan_restriction(const amr::Forest& forest, int level);

/// How many layers of columns each block must keep for the transfer between levels.
std::vector<ColumnDepth> column_depths(const amr::Forest& forest);

}  // namespace drogue::lbm
