// SPDX-License-Identifier: GPL-3.0-or-later
// Block forest: a brick of octrees (p8est) whose leaves are blocks of 16^3 cells, 2:1 balanced across
// faces, edges and corners. Geometry and topology only; field data lives with the solvers, indexed by
// block id.
//
// Besides its leaves a level holds three kinds of blocks that complete the neighbourhood of a leaf, so
// that a kernel sees neighbours of its own level only:
//   parent    covered by leaves of finer levels; holds the field restricted from its children
//   ghost     lies in a leaf of the next coarser level (its host); holds the field interpolated from it
//   boundary  lies outside the domain; holds what the boundary condition asks for
// Reference: Burstedde, Wilcox & Ghattas, SIAM J. Sci. Comput. 33 (2011) 1103.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/types.hpp"

namespace drogue::amr {

inline constexpr int block_size = 16;  ///< cells per block edge
inline constexpr int block_cells = block_size * block_size * block_size;
inline constexpr int none = -1;

/// Cell number `i` of a block in the order [z][y][x].
constexpr Index3 cell_at(int i) { return {i % block_size, i / block_size % block_size, i / (block_size * block_size)}; }

enum class Kind : std::uint8_t { leaf, parent, ghost, boundary };

/// Position of the neighbour at `offset` (each of -1, 0, 1) among the 27; the block itself is 13.
constexpr int neighbour_slot(int dx, int dy, int dz) { return (dz + 1) * 9 + (dy + 1) * 3 + (dx + 1); }
constexpr Index3 slot_offset(int slot) { return {slot % 3 - 1, slot / 3 % 3 - 1, slot / 9 - 1}; }

struct Block {
  int level;
  Kind kind;
  Index3 index;                   ///< block coordinates within the level; may be -1 or n for `boundary`
  std::array<int, 27> neighbour;  ///< ids on the same level. Leaves: all set. Parents, ghosts and boundaries:
                                  ///< those that exist, else `none`; periodic images are the real block
  int parent;                     ///< id of the block of the next coarser level that covers this one (for a
                                  ///< ghost: its host, a leaf); `none` at level 0 and for `boundary`
  std::array<int, 8> child;       ///< of a parent: ids in the order x fastest; else all `none`
};

/// The root brick: what the forest is before any refinement.
struct Domain {
  Box box;          ///< [m]; each edge is a multiple of block_size * coarsest
  double coarsest;  ///< cell edge on level 0 [m]
  std::array<bool, 3> periodic{false, false, false};
};

/// Should a block of `level` that covers `box` [m] be refined?
using RefinementCriterion = std::function<bool(const Box& box, int level)>;

/// Half-open range of block ids.
struct BlockRange {
  int begin, end;
  int size() const { return end - begin; }
};

struct Location {
  int block;    ///< id of the leaf
  Index3 cell;  ///< cell inside the block
};

class Forest {
 public:
  /// Builds the forest by refining where `criterion` asks for it, to at most `finest_level`, then balancing.
  /// Throws InputError if the box is not a multiple of the root block.
  Forest(const Domain& domain, int finest_level, const RefinementCriterion& criterion);

  const Domain& domain() const { return domain_; }
  int levels() const { return static_cast<int>(ranges_.size()); }  ///< levels in use: 1 + the finest that occurs
  int finest() const { return levels() - 1; }
  double spacing(int level) const;        ///< cell edge [m]
  Index3 blocks_across(int level) const;  ///< blocks in x, y, z that would fill the domain

  int size() const { return static_cast<int>(blocks_.size()); }
  const Block& block(int id) const { return blocks_[id]; }
  /// Ids are contiguous by level and, within a level, by kind (leaf, parent, ghost, boundary); leaves are in
  /// Morton order.
  BlockRange range(int level, Kind kind) const { return ranges_[level][static_cast<int>(kind)]; }
  BlockRange range(int level) const { return {ranges_[level][0].begin, ranges_[level][3].end}; }

  Vec3 lower(int id) const;  ///< lower corner of a block [m]
  Box box(int id) const;
  Vec3 cell_centre(int id, const Index3& cell) const;  ///< [m]

  /// Faces of the domain beyond which a `boundary` block lies, one for each axis at most, ascending: x_min, x_max,
  /// y_min, y_max, z_min, z_max from 0 on.
  std::vector<int> faces_beyond(int id) const;
  /// Does a block lie beyond the domain along this axis?
  bool is_beyond(int id, int axis) const {
    return block(id).index[axis] < 0 || block(id).index[axis] >= blocks_across(block(id).level)[axis];
  }

  /// The leaf and cell that hold a point [m]; nothing outside the domain (periodic axes wrap).
  std::optional<Location> locate(const Vec3& point) const;
  /// Id of the block of `level` at block coordinates `index` (periodic axes wrap), or `none`.
  int find(int level, Index3 index) const;

  std::int64_t cells(int level) const { return std::int64_t{range(level, Kind::leaf).size()} * block_cells; }

 private:
  void add(int level, Kind kind, const Index3& index);
  void surround_leaves(int level, Kind kind);  // adds the ghosts, or the boundary blocks, of a level
  void link(int id);
  bool is_complete(int id) const;  // what this header promises of a block's links
  Index3 wrap(int level, Index3 index) const;
  bool is_outside(int level, const Index3& index) const;
  Box box(int level, const Index3& index) const;

  Domain domain_;
  Index3 roots_;  // blocks across on level 0
  std::vector<Block> blocks_;
  std::vector<std::array<BlockRange, 4>> ranges_;
  std::unordered_map<std::uint64_t, int> by_index_;  // (level, index) -> id, boundary blocks included
};

/// Version of the library that keeps the octree.
std::string octree_library_version();

/// Refine blocks that share volume with `region` until their cells are at most `spacing` [m]; a region that is flat
/// along an axis refines the blocks on both sides of a face it lies on. Throws InputError if `spacing` is not positive.
RefinementCriterion refine_box(const Box& region, double coarsest, double spacing);

/// Refine blocks within `distance` [m] of the points swept along `sweep` [m] until cells are at most `spacing` [m];
/// distances are in the maximum norm. The points are copied. Throws InputError if `spacing` is not positive.
RefinementCriterion refine_near(std::span<const Vec3> points, double distance, const Vec3& sweep, double coarsest,
                                double spacing);

/// Refine where any of the criteria asks for it.
RefinementCriterion any_of(std::vector<RefinementCriterion> criteria);

}  // namespace drogue::amr
