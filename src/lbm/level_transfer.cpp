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

void close_target(TransferPlan& plan) {
  if (plan.first.back() != static_cast<int>(plan.job.size())) plan.first.push_back(static_cast<int>(plan.job.size()));
}

/// A job for the part `box` of the rim of `target` that faces `offset`: columns if that is across an x face.
ResampleJob job_for(int target, const Index3& offset, const CellBox& box) {
  ResampleJob job{};
  job.target = target;
  job.normal = offset[0] != 0 ? 0 : offset[1] != 0 ? 1 : 2;
  const auto range = [&](int a) { return ResampleJob::Range{box.begin[a], box.end[a]}; };
  job.layers = range(job.normal);
  job.lines = range(job.across());
  job.cells = range(job.along());
  return job;
}

/// Sets the source of a job from a function of the place in the pairs, {0 or 1 in x, y, z}.
template <class F>
void set_source(ResampleJob& job, const F& id_at) {
  for (int i = 0; i < 8; ++i) {
    Index3 place;
    place[job.normal] = i >> 2;
    place[job.across()] = i >> 1 & 1;
    place[job.along()] = i & 1;
    job.source[i] = id_at(place);
  }
}

bool touches_boundary(const amr::Forest& forest, int id) {
  for (const int neighbour : forest.block(id).neighbour)
    if (neighbour != amr::none && forest.block(neighbour).kind == amr::Kind::boundary) return true;
  return false;
}

/// Parents of `level` of which a part at an x face is read along x, by the interpolation onto a y or z face: where a
/// host lies beside them. (If a leaf lies between, that part is at a y or z face too.)
std::vector<bool> read_along_x(const amr::Forest& forest, int level) {
  std::vector<bool> read(forest.size(), false);
  const auto is_parent = [&](int id) { return forest.block(id).kind == amr::Kind::parent; };
  for (const ResampleJob& job : plan_interpolation(forest, level + 1).job) {
    if (job.normal == 0) continue;
    std::array<int, 3> host;  // its place in the pairs
    for (int a = 0; a < 3; ++a) host[a] = 1 - job.rule[a] / 2;
    const int beside = 1 - host[2];
    if (!is_parent(job.source[4 * host[0] + 2 * host[1] + beside])) continue;
    for (int i = 0; i < 4; ++i)
      if (is_parent(job.source[2 * i + beside])) read[job.source[2 * i + beside]] = true;
  }
  return read;
}

}  // namespace

TransferPlan plan_interpolation(const amr::Forest& forest, int level) {
  TransferPlan plan{{}, {0}};
  const auto ghosts = forest.range(level, amr::Kind::ghost);
  for (int id = ghosts.begin; id < ghosts.end; ++id) {
    const amr::Block& ghost = forest.block(id);
    Index3 half;
    Sides used;
    for (int a = 0; a < 3; ++a) {
      half[a] = ghost.index[a] & 1;
      used[a] = {half[a] == 0, half[a] == 1};
    }
    const Sides available = available_sides(forest, ghost.parent, used);
    for (const auto& [offset, box] : rims(leaf_offsets(forest, id, 2), 1, n)) {
      ResampleJob job = job_for(id, offset, box);
      const auto rule = [&](int a) { return 2 * half[a] + available[a][half[a]]; };
      job.rule = {rule(job.normal), rule(job.across()), rule(job.along())};
      job.also_rows = touches_boundary(forest, id);
      set_source(job, [&](const Index3& place) {
        Index3 o;
        for (int a = 0; a < 3; ++a) o[a] = available[a][half[a]] ? place[a] + half[a] - 1 : 0;
        return forest.block(ghost.parent).neighbour[amr::neighbour_slot(o[0], o[1], o[2])];
      });
      plan.job.push_back(job);
    }
    close_target(plan);
  }
  return plan;
}

TransferPlan plan_restriction(const amr::Forest& forest, int level) {
  TransferPlan plan{{}, {0}};
  const std::vector<bool> also_rows = read_along_x(forest, level);
  const auto parents = forest.range(level, amr::Kind::parent);
  for (int id = parents.begin; id < parents.end; ++id) {
    for (const auto& [offset, box] : rims(leaf_offsets(forest, id, 3), depth, n)) {
      ResampleJob job = job_for(id, offset, box);
      job.rule.fill(restriction_rule);
      job.also_rows = also_rows[id] || touches_boundary(forest, id);
      set_source(job, [&, o = offset](Index3 place) {
        for (int a = 0; a < 3; ++a)
          if (o[a] != 0) place[a] = o[a] > 0;  // the children that touch the leaf
        return forest.block(id).child[4 * place[2] + 2 * place[1] + place[0]];
      });
      // a job reads up to 16 lines
      for (const int begin : {0, n / 2}) {
        ResampleJob part = job;
        part.lines = {std::max(job.lines.begin, begin), std::min(job.lines.end, begin + n / 2)};
        if (part.lines.begin < part.lines.end) plan.job.push_back(part);
      }
    }
    close_target(plan);
  }
  return plan;
}

std::vector<ColumnDepth> column_depths(const amr::Forest& forest) {
  std::vector<ColumnDepth> result(forest.size(), {1, 1});
  const auto keep = [&](int id, int x) {
    const int side = x >= n / 2, layer = side ? n - 1 - x : x;
    result[id][side] = std::max(result[id][side], layer + 1);
  };
  const auto keep_for = [&](const TransferPlan& plan) {
    for (const ResampleJob& job : plan.job) {
      if (job.normal != 0) continue;
      const Axis axis = axis_of_rule(job.rule[0]);
      for (int i = job.layers.begin; i < job.layers.end; ++i) {
        keep(job.target, i);
        for (int x = axis.start[i]; x < axis.start[i] + axis.taps; ++x)
          for (int k = 0; k < 4; ++k) keep(job.source[x / n * 4 + k], x % n);
      }
    }
  };
  for (int level = 0; level < forest.levels(); ++level) {
    if (level > 0) keep_for(plan_interpolation(forest, level));
    if (level < forest.finest()) keep_for(plan_restriction(forest, level));
  }
  return result;
}

}  // namespace drogue::lbm
