// SPDX-License-Identifier: GPL-3.0-or-later
// From the leaves of the octree to blocks with links.
//
// A level is completed around its leaves: whatever of the 26 places around a leaf is neither leaf nor parent
// becomes a ghost inside the domain and a boundary block outside. Two facts follow.
//   The host of a ghost is a leaf of the next coarser level: the ghost's place is covered by a coarser leaf, that
//   leaf touches the leaf the ghost was made for, and balance across faces, edges and corners lets their levels
//   differ by one at most.
//   Moving a boundary block one block inward, along any axis in which it is outside, reaches a block that exists:
//   the leaf it was made for has the same coordinate along that axis after the move, so the place reached is
//   again among the 26 around that leaf, or the leaf itself.
#include "amr/forest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "amr/octree.hpp"
#include "core/error.hpp"

namespace drogue::amr {
namespace {

constexpr int index_bits = 19;
constexpr int most_blocks_across = (1 << index_bits) - 2;  // -1 and n must fit as well

/// Level and index in one word, 7 + 3 x 19 bits.
std::uint64_t key(int level, const Index3& index) {
  auto word = static_cast<std::uint64_t>(level);
  for (int a = 0; a < 3; ++a) word = word << index_bits | static_cast<std::uint64_t>(index[a] + 1);
  return word;
}

/// Number of root blocks along each axis; throws InputError if the domain is not made of whole ones.
Index3 count_root_blocks(const Domain& domain, int finest_level) {
  const double root = block_size * domain.coarsest;
  if (!(root > 0) || !std::isfinite(root)) {
    throw InputError(fmt::format("the coarsest cell edge is {} m, but must be positive", domain.coarsest));
  }
  if (finest_level < 0 || finest_level > deepest_level) {
    throw InputError(fmt::format("the finest level is {}, but must be from 0 to {}", finest_level, deepest_level));
  }
  Index3 count;
  for (int a = 0; a < 3; ++a) {
    const char axis = "xyz"[a];
    const double edge = domain.box.size()[a];
    if (!(edge > 0) || !std::isfinite(edge)) {
      throw InputError(fmt::format("the domain extends from {} m to {} m along {}, but its edge must be positive",
                                   domain.box.lower[a], domain.box.upper[a], axis));
    }
    const double whole = std::max(1.0, std::round(edge / root));
    if (std::abs(edge - whole * root) > 1e-9 * edge) {
      throw InputError(fmt::format(
          "the domain's edge along {} is {:.10g} m, but must be a multiple of {:.10g} m ({} cells of {:.10g} m); the "
          "nearest is {:.10g} m",
          axis, edge, root, block_size, domain.coarsest, whole * root));
    }
    if (std::ldexp(whole, finest_level) > most_blocks_across) {
      throw InputError(fmt::format("level {} would have {:.0f} blocks along {}, but at most {} are possible",
                                   finest_level, std::ldexp(whole, finest_level), axis, most_blocks_across));
    }
    count[a] = static_cast<int>(whole);
  }
  return count;
}

constexpr Index3 plus(const Index3& a, const Index3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
constexpr Index3 half(const Index3& a) { return {a[0] >> 1, a[1] >> 1, a[2] >> 1}; }
constexpr Index3 child_index(const Index3& parent, int child) {
  return {2 * parent[0] + (child & 1), 2 * parent[1] + (child >> 1 & 1), 2 * parent[2] + (child >> 2)};
}

/// Leaves and parents of each level, in Morton order.
struct Level {
  std::vector<Index3> leaves, parents;
};

std::vector<Level> sort_by_level(const std::vector<Leaf>& leaves) {
  std::vector<Level> levels;
  for (const Leaf& leaf : leaves) {
    if (leaf.level >= static_cast<int>(levels.size())) levels.resize(leaf.level + 1);
    levels[leaf.level].leaves.push_back(leaf.index);
    Index3 ancestor = half(leaf.index);
    for (int level = leaf.level - 1; level >= 0; --level, ancestor = half(ancestor)) {
      // In Morton order the leaves under one ancestor follow each other.
      auto& parents = levels[level].parents;
      if (!parents.empty() && parents.back() == ancestor) break;
      parents.push_back(ancestor);
    }
  }
  return levels;
}

}  // namespace

Forest::Forest(const Domain& domain, int finest_level, const RefinementCriterion& criterion)
    : domain_(domain), roots_(count_root_blocks(domain, finest_level)) {
  const std::vector<Level> found =
      sort_by_level(balanced_leaves(roots_, domain.periodic, finest_level, [&](int level, const Index3& index) {
        return criterion(box(level, index), level);
      }));
  for (int level = 0; level < static_cast<int>(found.size()); ++level) {
    ranges_.emplace_back();
    for (const Kind kind : {Kind::leaf, Kind::parent, Kind::ghost, Kind::boundary}) {
      BlockRange& range_of_kind = ranges_[level][static_cast<int>(kind)];
      range_of_kind.begin = size();
      switch (kind) {
        case Kind::leaf:
          for (const Index3& index : found[level].leaves) add(level, kind, index);
          break;
        case Kind::parent:
          for (const Index3& index : found[level].parents) add(level, kind, index);
          break;
        case Kind::ghost:
        case Kind::boundary:
          surround_leaves(level, kind);
      }
      range_of_kind.end = size();
    }
  }
  for (int id = 0; id < size(); ++id) link(id);
  for (int id = 0; id < size(); ++id) assert(is_complete(id));
}

void Forest::add(int level, Kind kind, const Index3& index) {
  Block block{level, kind, index, {}, none, {}};
  block.neighbour.fill(none);
  block.child.fill(none);
  by_index_.emplace(key(level, index), size());
  blocks_.push_back(block);
}

void Forest::surround_leaves(int level, Kind kind) {
  const BlockRange leaves = range(level, Kind::leaf);
  for (int id = leaves.begin; id < leaves.end; ++id) {
    for (int slot = 0; slot < 27; ++slot) {
      const Index3 index = wrap(level, plus(blocks_[id].index, slot_offset(slot)));
      const bool missing = find(level, index) == none;
      if (missing && is_outside(level, index) == (kind == Kind::boundary)) add(level, kind, index);
    }
  }
}

void Forest::link(int id) {
  Block& block = blocks_[id];
  for (int slot = 0; slot < 27; ++slot) {
    block.neighbour[slot] = find(block.level, plus(block.index, slot_offset(slot)));
  }
  if (block.level > 0 && block.kind != Kind::boundary) block.parent = find(block.level - 1, half(block.index));
  if (block.kind == Kind::parent) {
    for (int c = 0; c < 8; ++c) block.child[c] = find(block.level + 1, child_index(block.index, c));
  }
}

bool Forest::is_complete(int id) const {
  const Block& block = blocks_[id];
  const auto exists = [](int other) { return other != none; };
  const auto parent_is = [&](Kind kind) { return exists(block.parent) && blocks_[block.parent].kind == kind; };
  switch (block.kind) {
    case Kind::leaf:
      return std::ranges::all_of(block.neighbour, exists) && (block.level == 0 || parent_is(Kind::parent));
    case Kind::parent:
      return std::ranges::all_of(block.child, exists) && (block.level == 0 || parent_is(Kind::parent));
    case Kind::ghost:
      return parent_is(Kind::leaf);
    case Kind::boundary:
      break;
  }
  for (int a = 0; a < 3; ++a) {
    Index3 inward = block.index;
    inward[a] = std::clamp(inward[a], 0, blocks_across(block.level)[a] - 1);
    if (find(block.level, inward) == none) return false;
  }
  return true;
}

double Forest::spacing(int level) const { return std::ldexp(domain_.coarsest, -level); }

Index3 Forest::blocks_across(int level) const { return {roots_[0] << level, roots_[1] << level, roots_[2] << level}; }

Box Forest::box(int level, const Index3& index) const {
  const double edge = block_size * spacing(level);
  const Vec3 corner(index[0], index[1], index[2]);
  return {domain_.box.lower + edge * corner, domain_.box.lower + edge * (corner + Vec3::Ones())};
}

Box Forest::box(int id) const { return box(blocks_[id].level, blocks_[id].index); }

Vec3 Forest::lower(int id) const { return box(id).lower; }

Vec3 Forest::cell_centre(int id, const Index3& cell) const {
  return lower(id) + spacing(blocks_[id].level) * Vec3(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5);
}

Index3 Forest::wrap(int level, Index3 index) const {
  const Index3 across = blocks_across(level);
  for (int a = 0; a < 3; ++a) {
    if (!domain_.periodic[a] || (index[a] >= 0 && index[a] < across[a])) continue;
    index[a] %= across[a];
    if (index[a] < 0) index[a] += across[a];
  }
  return index;
}

bool Forest::is_outside(int level, const Index3& index) const {
  const Index3 across = blocks_across(level);
  for (int a = 0; a < 3; ++a) {
    if (index[a] < 0 || index[a] >= across[a]) return true;
  }
  return false;
}

int Forest::find(int level, Index3 index) const {
  if (level < 0 || level >= levels()) return none;
  index = wrap(level, index);
  const Index3 across = blocks_across(level);
  for (int a = 0; a < 3; ++a) {
    if (index[a] < -1 || index[a] > across[a]) return none;
  }
  const auto found = by_index_.find(key(level, index));
  return found == by_index_.end() ? none : found->second;
}

std::vector<int> Forest::faces_beyond(int id) const {
  std::vector<int> faces;
  for (int a = 0; a < 3; ++a)
    if (is_beyond(id, a)) faces.push_back(2 * a + (block(id).index[a] >= 0));
  return faces;
}

std::optional<Location> Forest::locate(const Vec3& point) const {
  const Index3 across = blocks_across(finest());
  Index3 cell;  // the finest level's cell that would hold the point
  for (int a = 0; a < 3; ++a) {
    double x = point[a] - domain_.box.lower[a];
    if (domain_.periodic[a]) {
      const double edge = roots_[a] * block_size * domain_.coarsest;
      x = std::fmod(x, edge);  // not a number where x is infinite
      if (x < 0) x += edge;
    } else if (point[a] < domain_.box.lower[a] || point[a] > domain_.box.upper[a]) {
      return std::nullopt;
    }
    if (std::isnan(x)) return std::nullopt;
    // The upper edge of the domain, exact or up to round-off, belongs to the last cell.
    cell[a] = std::min(static_cast<int>(x / spacing(finest())), across[a] * block_size - 1);
  }
  for (int level = finest(); level >= 0; --level, cell = half(cell)) {
    const Index3 index{cell[0] / block_size, cell[1] / block_size, cell[2] / block_size};
    const int id = find(level, index);
    if (id != none && blocks_[id].kind == Kind::leaf) {
      return Location{id, {cell[0] % block_size, cell[1] % block_size, cell[2] % block_size}};
    }
  }
  assert(false && "the leaves cover the domain");
  return std::nullopt;
}

}  // namespace drogue::amr
