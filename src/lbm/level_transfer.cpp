// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/level_transfer.hpp"

#include <algorithm>
#include <cstdlib>

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;
constexpr int depth = 2;  // layers of a parent that are filled

struct CellBox {
  Index3 begin, end;

  bool contains(const CellBox& other) const {
    for (int a = 0; a < 3; ++a)
      if (other.begin[a] < begin[a] || other.end[a] > end[a]) return false;
    return true;
  }
};

/// The cells of a block of `size` cells within `layers` of the neighbour at `offset`.
CellBox rim(const Index3& offset, int layers, int size) {
  CellBox box;
  for (int a = 0; a < 3; ++a) {
    box.begin[a] = offset[a] > 0 ? size - layers : 0;
    box.end[a] = offset[a] < 0 ? layers : size;
  }
  return box;
}

/// Offsets of the neighbours of `id` that are leaves, faces first, then edges, then corners.
std::vector<Index3> leaf_offsets(const amr::Forest& forest, int id, int farthest) {
  std::vector<Index3> offsets;
  for (int distance = 1; distance <= farthest; ++distance)
    for (int slot = 0; slot < 27; ++slot) {
      const Index3 o = amr::slot_offset(slot);
      if (std::abs(o[0]) + std::abs(o[1]) + std::abs(o[2]) != distance) continue;
      const int neighbour = forest.block(id).neighbour[slot];
      if (neighbour != amr::none && forest.block(neighbour).kind == amr::Kind::leaf) offsets.push_back(o);
    }
  return offsets;
}

/// Drops boxes that lie inside an earlier one.
std::vector<CellBox> without_repeats(const std::vector<CellBox>& boxes) {
  std::vector<CellBox> kept;
  for (const CellBox& box : boxes)
    if (std::none_of(kept.begin(), kept.end(), [&](const CellBox& k) { return k.contains(box); })) kept.push_back(box);
  return kept;
}

using Sides = std::array<std::array<bool, 2>, 3>;  // [axis][low, high]

amr::Kind kind_at(const amr::Forest& forest, int id, const Index3& offset) {
  const int neighbour = forest.block(id).neighbour[amr::neighbour_slot(offset[0], offset[1], offset[2])];
  return neighbour == amr::none ? amr::Kind::boundary : forest.block(neighbour).kind;
}

bool holds_field(amr::Kind kind) { return kind == amr::Kind::leaf || kind == amr::Kind::parent; }

/// Of the sides that a tensor-product stencil of block `id` would use, those it may: every neighbour that a combination
/// of them reaches holds a field of its own. At a concave corner one axis gives way, one whose face is no parent if
/// there is one, so that the stencil keeps straddling the interface.
Sides available_sides(const amr::Forest& forest, int id, Sides sides) {
  const auto reaches = [&](const Index3& o) {
    for (int a = 0; a < 3; ++a)
      if (o[a] != 0 && !sides[a][o[a] > 0]) return false;
    return true;
  };
  for (int distance = 1; distance <= 3; ++distance)
    for (int slot = 0; slot < 27; ++slot) {
      const Index3 o = amr::slot_offset(slot);
      if (std::abs(o[0]) + std::abs(o[1]) + std::abs(o[2]) != distance || !reaches(o)) continue;
      if (holds_field(kind_at(forest, id, o))) continue;
      int gives_way = amr::none;
      for (int a = 0; a < 3; ++a) {
        if (o[a] == 0) continue;
        Index3 face{0, 0, 0};
        face[a] = o[a];
        if (gives_way == amr::none || kind_at(forest, id, face) != amr::Kind::parent) gives_way = a;
      }
      sides[gives_way][o[gives_way] > 0] = false;
    }
  return sides;
}

void close_target(TransferPlan& plan) {
  if (plan.first.back() != static_cast<int>(plan.job.size())) plan.first.push_back(static_cast<int>(plan.job.size()));
}

}  // namespace

TransferPlan plan_interpolation(const amr::Forest& forest, int level) {
  TransferPlan plan{{}, {0}};
  const auto ghosts = forest.range(level, amr::Kind::ghost);
  for (int id = ghosts.begin; id < ghosts.end; ++id) {
    const amr::Block& ghost = forest.block(id);
    Sides used;
    Index3 half;
    for (int a = 0; a < 3; ++a) {
      half[a] = ghost.index[a] & 1;
      used[a] = {half[a] == 0, half[a] == 1};
    }
    const Sides available = available_sides(forest, ghost.parent, used);
    std::vector<CellBox> boxes;
    for (const Index3& offset : leaf_offsets(forest, id, 2)) boxes.push_back(rim(offset, 1, n));
    for (const CellBox& box : without_repeats(boxes)) {
      ResampleJob job{ghost.parent, id, {}, {0, 0, 0}};
      for (int a = 0; a < 3; ++a) job.axis[a] = cubic_axis(box.begin[a], box.end[a], half[a], available[a]);
      plan.job.push_back(job);
    }
    close_target(plan);
  }
  return plan;
}

TransferPlan plan_restriction(const amr::Forest& forest, int level) {
  TransferPlan plan{{}, {0}};
  const auto parents = forest.range(level, amr::Kind::parent);
  for (int id = parents.begin; id < parents.end; ++id) {
    const auto offsets = leaf_offsets(forest, id, 3);
    for (int octant = 0; octant < 8; ++octant) {
      const Index3 half{octant & 1, octant >> 1 & 1, octant >> 2};
      std::vector<CellBox> boxes;
      for (const Index3& o : offsets) {
        bool touches = true;
        for (int a = 0; a < 3; ++a) touches &= o[a] == 0 || (o[a] > 0) == (half[a] == 1);
        if (touches) boxes.push_back(rim(o, depth, n / 2));
      }
      const int child = forest.block(id).child[octant];
      for (const CellBox& box : without_repeats(boxes)) {
        ResampleJob job{child, id, {}, {half[0] * n / 2, half[1] * n / 2, half[2] * n / 2}};
        for (int a = 0; a < 3; ++a) job.axis[a] = restriction_axis(box.begin[a], box.end[a]);
        plan.job.push_back(job);
      }
    }
    close_target(plan);
  }
  return plan;
}

}  // namespace drogue::lbm
