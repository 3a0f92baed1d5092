// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/level_transfer.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <utility>

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

struct Rim {
  Index3 offset;
  CellBox box;
};

/// The rims towards `offsets`, without those that lie inside an earlier one.
std::vector<Rim> rims(const std::vector<Index3>& offsets, int layers, int size) {
  std::vector<Rim> kept;
  for (const Index3& offset : offsets) {
    const CellBox box = rim(offset, layers, size);
    if (std::none_of(kept.begin(), kept.end(), [&](const Rim& k) { return k.box.contains(box); }))
      kept.push_back({offset, box});
  }
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

/// Blocks a rim is interpolated from: pairs along each axis, {0 or 1 in x, y, z}; of an axis without pairs the same
/// twice.
using Sources = std::array<std::array<std::array<int, 2>, 2>, 2>;  // [x][y][z]

/// How the rims of a ghost are interpolated.
struct GhostStencil {
  std::array<int, 3> rule;  ///< by axis
  Sources source;
};

GhostStencil stencil_of(const amr::Forest& forest, const amr::Block& ghost) {
  Index3 half;
  Sides used;
  for (int a = 0; a < 3; ++a) {
    half[a] = ghost.index[a] & 1;
    used[a] = {half[a] == 0, half[a] == 1};
  }
  const Sides available = available_sides(forest, ghost.parent, used);
  GhostStencil stencil;
  for (int a = 0; a < 3; ++a) stencil.rule[a] = 2 * half[a] + available[a][half[a]];
  for (int i = 0; i < 8; ++i) {
    const Index3 place{i & 1, i >> 1 & 1, i >> 2};
    Index3 o;
    for (int a = 0; a < 3; ++a) o[a] = available[a][half[a]] ? place[a] + half[a] - 1 : 0;
    stencil.source[place[0]][place[1]][place[2]] =
        forest.block(ghost.parent).neighbour[amr::neighbour_slot(o[0], o[1], o[2])];
  }
  return stencil;
}

int normal_to(const Index3& offset) { return offset[0] != 0 ? 0 : offset[1] != 0 ? 1 : 2; }

bool touches_boundary(const amr::Forest& forest, int id) {
  for (const int neighbour : forest.block(id).neighbour)
    if (neighbour != amr::none && forest.block(neighbour).kind == amr::Kind::boundary) return true;
  return false;
}

/// Collects sums of layers, each once.
class BlockSums {
 public:
  /// Of what a stencil along `normal` reads, for an output in the layer `output`, from the first or second block of
  /// its pair; `none` if it reads nothing there.
  int add(int block, int normal, int rule, int output, int part, const Range& lines) {
    const Axis axis = axis_of_rule(rule);
    LayerSum sum{normal, 0, 0, {}, {}};
    for (int k = 0; k < axis.taps; ++k) {
      const int layer = axis.start[output] + k;
      if (layer / n != part) continue;
      if (sum.taps == 0) sum.first = layer % n;
      sum.weight[sum.taps] = axis.weight[output][k];
      sum.curvature[sum.taps++] = axis.curvature[output][k];
    }
    if (sum.taps == 0) return amr::none;
    const auto [known, is_new] = number_.try_emplace({block, normal, rule, part}, static_cast<int>(sum_.size()));
    if (is_new) sum_.push_back({block, sum, lines});
    Range& all = sum_[known->second].lines;
    all = {std::min(all.begin, lines.begin), std::max(all.end, lines.end)};
    return known->second;
  }
  std::vector<BlockSum> take() { return std::move(sum_); }

 private:
  std::map<std::array<int, 4>, int> number_;
  std::vector<BlockSum> sum_;
};

/// Parents of `level` of which a part at an x face is read along x, by the interpolation onto a y or z face: where a
/// host lies beside them. (If a leaf lies between, that part is at a y or z face too.)
std::vector<bool> read_along_x(const amr::Forest& forest, int level) {
  std::vector<bool> read(forest.size(), false);
  const auto is_parent = [&](int id) { return forest.block(id).kind == amr::Kind::parent; };
  const auto ghosts = forest.range(level + 1, amr::Kind::ghost);
  for (int id = ghosts.begin; id < ghosts.end; ++id) {
    const auto [rule, source] = stencil_of(forest, forest.block(id));
    std::array<int, 3> host;  // its place in the pairs
    for (int a = 0; a < 3; ++a) host[a] = 1 - rule[a] / 2;
    const auto& beside = source[1 - host[0]];
    for (const auto& [offset, box] : rims(leaf_offsets(forest, id, 2), 1, n)) {
      if (normal_to(offset) == 0 || !is_parent(beside[host[1]][host[2]])) continue;
      for (const auto& along_y : beside)
        for (const int block : along_y)
          if (is_parent(block)) read[block] = true;
    }
  }
  return read;
}

}  // namespace

InterpolationPlan plan_interpolation(const amr::Forest& forest, int level) {
  InterpolationPlan plan;
  BlockSums sums;
  const auto ghosts = forest.range(level, amr::Kind::ghost);
  for (int id = ghosts.begin; id < ghosts.end; ++id) {
    const auto [rule, source] = stencil_of(forest, forest.block(id));
    for (const auto& [offset, box] : rims(leaf_offsets(forest, id, 2), 1, n)) {
      const int normal = normal_to(offset), across = across_axis(normal), along = along_axis(normal);
      const auto range = [&, &box = box](int a) { return Range{box.begin[a], box.end[a]}; };
      RimJob job{id,
                 normal,
                 box.begin[normal],
                 range(across),
                 range(along),
                 rule[across],
                 rule[along],
                 {},
                 normal == 2 || (normal == 0 && touches_boundary(forest, id))};
      const Axis axis = axis_of_rule(job.across_rule);
      const int first = axis.start[job.lines.begin], end = axis.start[job.lines.end - 1] + axis.taps;
      for (int i = 0; i < 8; ++i) {
        Index3 place;
        place[normal] = i >> 2;
        place[across] = i >> 1 & 1;
        place[along] = i & 1;
        const Range lines{std::clamp(first - place[across] * n, 0, n), std::clamp(end - place[across] * n, 0, n)};
        job.sum[place[across]][place[along]][place[normal]] =
            sums.add(source[place[0]][place[1]][place[2]], normal, rule[normal], job.layer, place[normal], lines);
      }
      for (auto& pair : job.sum)
        for (auto& [one, other] : pair)
          if (one == amr::none) std::swap(one, other);
      plan.job.push_back(job);
    }
    const int jobs = static_cast<int>(plan.job.size());
    if (plan.first.back() != jobs) plan.first.push_back(jobs);
  }
  plan.sum = sums.take();
  return plan;
}

RestrictionPlan plan_restriction(const amr::Forest& forest, int level) {
  const auto parents = forest.range(level - 1, amr::Kind::parent);
  const std::vector<bool> along_x = read_along_x(forest, level - 1);
  std::vector<bool> in_columns(forest.size(), false);  // blocks whose columns are interpolated
  for (const BlockSum& of_block : plan_interpolation(forest, level).sum)
    if (of_block.sum.normal == 0) in_columns[of_block.block] = true;
  RestrictionPlan plan(forest, level);
  for (int id = parents.begin; id < parents.end; ++id)
    for (const auto& [offset, box] : rims(leaf_offsets(forest, id, 3), depth, n))
      for (int octant = 0; octant < 8; ++octant) {
        bool touches = true;
        for (int a = 0; a < 3; ++a) touches &= offset[a] == 0 || (octant >> a & 1) == (offset[a] > 0);
        if (!touches) continue;
        const int normal = normal_to(offset), face = 2 * normal + (offset[normal] > 0);
        auto& faces = plan[forest.block(id).child[octant]];
        if (std::ranges::any_of(faces, [&](const RimFace& rim) { return rim.face == face; })) continue;
        const bool copy = normal == 2 || (normal == 1 ? in_columns[id] : along_x[id] || touches_boundary(forest, id));
        faces.push_back({face, copy});
      }
  return plan;
}

bool is_in_columns(const amr::Forest& forest, int id, const Index3& first, int along) {
  const auto [x, y, z] = first;
  if (along == 0 || (x != 0 && x != n - 1)) return false;
  if (forest.block(id).kind == amr::Kind::boundary) return forest.is_beyond(id, 0);
  return along == 1 || !edge_is_in_rows(forest, id, {x ? 1 : -1, y ? 1 : -1, 0});
}

std::vector<std::uint32_t> columns_beside(const amr::Forest& forest) {
  std::vector<std::uint32_t> beside(forest.size(), 0);
  for (int level = 0; level < forest.levels(); ++level) {
    const auto leaves = forest.range(level, amr::Kind::leaf);
    for (int id = leaves.begin; id < leaves.end; ++id)
      for (int slot = 0; slot < 27; ++slot) {
        const Index3 o = amr::slot_offset(slot);
        if (o[0] == 0) continue;
        Index3 first;
        for (int a = 0; a < 3; ++a) first[a] = o[a] < 0 ? n - 1 : 0;
        const int along = o[1] != 0 && o[2] == 0 ? 2 : 1;
        if (is_in_columns(forest, forest.block(id).neighbour[slot], first, along)) beside[id] |= 1u << slot;
      }
  }
  return beside;
}

bool edge_is_in_rows(const amr::Forest& forest, int id, const Index3& towards) {
  const amr::Kind kind = forest.block(id).kind;
  if (kind != amr::Kind::ghost && kind != amr::Kind::parent) return false;
  return kind_at(forest, id, {towards[0], 0, 0}) != amr::Kind::leaf &&
         kind_at(forest, id, {0, towards[1], 0}) == amr::Kind::leaf;
}

std::vector<bool> deep_blocks(const amr::Forest& forest) {
  std::vector<bool> deep(forest.size(), false);
  for (int level = 1; level < forest.levels(); ++level) {
    const RestrictionPlan restriction = plan_restriction(forest, level);
    const auto leaves = forest.range(level, amr::Kind::leaf);
    for (int leaf = leaves.begin; leaf < leaves.end; ++leaf)
      for (const RimFace& rim : restriction[leaf])
        if (rim.face < 2) deep[forest.block(leaf).parent] = true;
  }
  return deep;
}

}  // namespace drogue::lbm
