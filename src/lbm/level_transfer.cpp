// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/level_transfer.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <utility>

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

struct CellBox {
  Index3 begin, end;

  bool contains(const CellBox& other) const {
    for (int a = 0; a < 3; ++a)
      if (other.begin[a] < begin[a] || other.end[a] > end[a]) return false;
    return true;
  }
};

/// The cells of a block next to the neighbour at `offset`.
CellBox rim(const Index3& offset) {
  CellBox box;
  for (int a = 0; a < 3; ++a) {
    box.begin[a] = offset[a] > 0 ? n - 1 : 0;
    box.end[a] = offset[a] < 0 ? 1 : n;
  }
  return box;
}

/// Offsets of the neighbours of `id` across faces, then across edges, that are leaves.
std::vector<Index3> leaf_offsets(const amr::Forest& forest, int id) {
  std::vector<Index3> offsets;
  for (int distance = 1; distance <= 2; ++distance)
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

/// The rims of a block towards leaves, without those that lie inside an earlier one.
std::vector<Rim> rims(const amr::Forest& forest, int id) {
  std::vector<Rim> kept;
  for (const Index3& offset : leaf_offsets(forest, id)) {
    const CellBox box = rim(offset);
    if (std::none_of(kept.begin(), kept.end(), [&](const Rim& k) { return k.box.contains(box); }))
      kept.push_back({offset, box});
  }
  return kept;
}

using Sides = std::array<std::array<bool, 2>, 3>;  // [axis][low, high]

int neighbour_at(const amr::Forest& forest, int id, const Index3& offset) {
  return forest.block(id).neighbour[amr::neighbour_slot(offset[0], offset[1], offset[2])];
}

amr::Kind kind_at(const amr::Forest& forest, int id, const Index3& offset) {
  const int neighbour = neighbour_at(forest, id, offset);
  return neighbour == amr::none ? amr::Kind::boundary : forest.block(neighbour).kind;
}

int normal_to(const Index3& offset) { return offset[0] != 0 ? 0 : offset[1] != 0 ? 1 : 2; }

/// Of the sides that a tensor-product stencil of block `id` would use, those it may: every neighbour that a combination
/// of them reaches is a leaf. Where none but the diagonal one is not, one axis gives way.
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
      if (kind_at(forest, id, o) == amr::Kind::leaf) continue;
      const int gives_way = normal_to(o);
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

bool touches_boundary(const amr::Forest& forest, int id) {
  for (const int neighbour : forest.block(id).neighbour)
    if (neighbour != amr::none && forest.block(neighbour).kind == amr::Kind::boundary) return true;
  return false;
}

/// Of the layers that a stencil reads for an output, those in the first or second block of its pair; perhaps none.
LayerSum part_of(const Axis& axis, int normal, int output, int part) {
  LayerSum sum{normal, 0, 0, {}, {}};
  for (int k = 0; k < axis.taps; ++k) {
    const int layer = axis.start[output] + k;
    if (layer / n != part) continue;
    if (sum.taps == 0) sum.first = layer % n;
    sum.weight[sum.taps] = axis.weight[output][k];
    sum.curvature[sum.taps++] = axis.curvature[output][k];
  }
  return sum;
}

/// A host's part in what lies along the interface at its face on that side.
LayerSum joint_sum(int normal, bool high) {
  constexpr int taps = interpolation_taps;
  const JointStencil joint = joint_stencil();
  LayerSum sum{normal, high ? n - taps : 0, taps, joint.weight, joint.curvature};
  if (high)
    for (Axis::Weights* w : {&sum.weight, &sum.curvature}) std::reverse(w->begin(), w->begin() + taps);
  return sum;
}

/// Collects sums of layers, each once.
class LeafSums {
 public:
  /// Number of the sum, `none` if it is empty.
  int add(int leaf, const LayerSum& sum, const Range& lines) {
    if (sum.taps == 0) return amr::none;
    for (const int i : of_leaf_[leaf]) {
      if (!(sum_[i].sum == sum)) continue;
      Range& all = sum_[i].lines;
      all = {std::min(all.begin, lines.begin), std::max(all.end, lines.end)};
      return i;
    }
    const int number = static_cast<int>(sum_.size());
    of_leaf_[leaf].push_back(number);
    sum_.push_back({leaf, sum, lines});
    return number;
  }
  std::vector<LeafSum> take() { return std::move(sum_); }

 private:
  std::map<int, std::vector<int>> of_leaf_;
  std::vector<LeafSum> sum_;
};

RimJob rim_job(const amr::Forest& forest, int ghost, const GhostStencil& stencil, const Rim& rim, LeafSums& sums) {
  const int normal = normal_to(rim.offset), across = across_axis(normal), along = along_axis(normal);
  const auto range = [&](int a) { return Range{rim.box.begin[a], rim.box.end[a]}; };
  const bool is_face = rim.offset[across] == 0 && rim.offset[along] == 0;
  RimJob job{ghost,
             normal,
             rim.box.begin[normal],
             is_face ? neighbour_at(forest, ghost, rim.offset) : amr::none,
             range(across),
             range(along),
             stencil.rule[across],
             stencil.rule[along],
             {},
             normal == 2 || (normal == 0 && touches_boundary(forest, ghost))};
  const Axis axis = axis_of_rule(job.across_rule);
  const int first = axis.start[job.lines.begin], end = axis.start[job.lines.end - 1] + axis.taps;
  for (int i = 0; i < 4; ++i) {
    Index3 place;
    place[across] = i >> 1;
    place[along] = i & 1;
    const Range lines{std::clamp(first - place[across] * n, 0, n), std::clamp(end - place[across] * n, 0, n)};
    const auto sum_of = [&](int part) {
      place[normal] = part;
      const LayerSum sum = is_face ? joint_sum(normal, rim.offset[normal] > 0)
                                   : part_of(axis_of_rule(stencil.rule[normal]), normal, job.layer, part);
      return sums.add(stencil.source[place[0]][place[1]][place[2]], sum, lines);
    };
    auto& [one, other] = job.sum[place[across]][place[along]];
    one = sum_of(0);
    other = is_face ? amr::none : sum_of(1);
    if (one == amr::none) std::swap(one, other);
  }
  return job;
}

}  // namespace

InterpolationPlan plan_interpolation(const amr::Forest& forest, int level) {
  InterpolationPlan plan;
  LeafSums sums;
  const auto ghosts = forest.range(level, amr::Kind::ghost);
  for (int id = ghosts.begin; id < ghosts.end; ++id) {
    const GhostStencil stencil = stencil_of(forest, forest.block(id));
    for (const Rim& rim : rims(forest, id)) plan.job.push_back(rim_job(forest, id, stencil, rim, sums));
    const int jobs = static_cast<int>(plan.job.size());
    if (plan.first.back() != jobs) plan.first.push_back(jobs);
  }
  plan.sum = sums.take();
  return plan;
}

RestrictionPlan plan_restriction(const amr::Forest& forest, int level) {
  const auto parents = forest.range(level - 1, amr::Kind::parent);
  RestrictionPlan plan(forest, level);
  for (int id = parents.begin; id < parents.end; ++id)
    for (const auto& [offset, box] : rims(forest, id))
      for (int octant = 0; octant < 8; ++octant) {
        bool touches = true;
        for (int a = 0; a < 3; ++a) touches &= offset[a] == 0 || (octant >> a & 1) == (offset[a] > 0);
        if (!touches) continue;
        const int normal = normal_to(offset), face = 2 * normal + (offset[normal] > 0);
        auto& faces = plan[forest.block(id).child[octant]];
        if (std::ranges::any_of(faces, [&](const RimFace& rim) { return rim.face == face; })) continue;
        faces.push_back({face, normal == 2 || (normal == 0 && touches_boundary(forest, id))});
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

}  // namespace drogue::lbm
