// SPDX-License-Identifier: GPL-3.0-or-later
// Reference: Burstedde, Wilcox & Ghattas, SIAM J. Sci. Comput. 33 (2011) 1103; balance: Isaac, Burstedde &
// Ghattas, IPDPS 2012. Limit: one rank (MPI_COMM_SELF).
#include "amr/octree.hpp"

#include <p8est_bits.h>
#include <p8est_extended.h>

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <exception>
#include <memory>

#include "amr/forest.hpp"
#include "amr/mpi_runtime.hpp"
#include "core/error.hpp"

namespace drogue::amr {
namespace {

static_assert(deepest_level == P8EST_QMAXLEVEL);

struct Destroy {
  void operator()(p8est_connectivity_t* brick) const { p8est_connectivity_destroy(brick); }
  void operator()(p8est_t* forest) const { p8est_destroy(forest); }
};
using Brick = std::unique_ptr<p8est_connectivity_t, Destroy>;
using Octree = std::unique_ptr<p8est_t, Destroy>;

/// Place of each tree in the brick. p4est numbers the trees along a Morton-like curve, and puts their vertices
/// at whole numbers.
std::vector<Index3> tree_places(const p8est_connectivity_t& brick) {
  std::vector<Index3> places(brick.num_trees);
  for (int tree = 0; tree < brick.num_trees; ++tree) {
    const double* corner = brick.vertices + 3 * brick.tree_to_vertex[P8EST_CHILDREN * tree];
    for (int a = 0; a < 3; ++a) places[tree][a] = static_cast<int>(std::lround(corner[a]));
  }
  return places;
}

Index3 block_index(const p8est_quadrant_t& quadrant, const Index3& tree) {
  const int shift = P8EST_MAXLEVEL - quadrant.level;
  return {(tree[0] << quadrant.level) + (quadrant.x >> shift), (tree[1] << quadrant.level) + (quadrant.y >> shift),
          (tree[2] << quadrant.level) + (quadrant.z >> shift)};
}

/// What p4est carries through to the callback.
struct Refinement {
  const RefineBlock& refine;
  const std::vector<Index3>& places;
  int finest_level;
  std::int64_t blocks = 0;     // leaves so far
  std::exception_ptr failure;  // must not cross p4est, which is C
};

int refine_quadrant(p8est_t* octree, p4est_topidx_t tree, p8est_quadrant_t* quadrant) {
  auto& refinement = *static_cast<Refinement*>(octree->user_pointer);
  if (refinement.failure || quadrant->level >= refinement.finest_level) return 0;
  try {
    const bool refined = refinement.refine(quadrant->level, block_index(*quadrant, refinement.places[tree]));
    if (refined) refinement.blocks += P8EST_CHILDREN - 1;
    if (refinement.blocks > most_blocks) {
      throw InputError(fmt::format("the grid has more than {} blocks of {}^3 cells", most_blocks, block_size));
    }
    return refined;
  } catch (...) {
    refinement.failure = std::current_exception();
    return 0;
  }
}

std::vector<Leaf> read_leaves(const p8est_t& octree, const std::vector<Index3>& places) {
  std::vector<Leaf> leaves;
  leaves.reserve(octree.local_num_quadrants);
  for (int tree = octree.first_local_tree; tree <= octree.last_local_tree; ++tree) {
    sc_array_t& quadrants = p8est_tree_array_index(octree.trees, tree)->quadrants;
    for (std::size_t q = 0; q < quadrants.elem_count; ++q) {
      const p8est_quadrant_t& quadrant = *p8est_quadrant_array_index(&quadrants, q);
      leaves.push_back({quadrant.level, block_index(quadrant, places[tree])});
    }
  }
  return leaves;
}

}  // namespace

std::vector<Leaf> balanced_leaves(const Index3& trees, const std::array<bool, 3>& periodic, int finest_level,
                                  const RefineBlock& refine) {
  start_mpi();
  const Brick brick(p8est_connectivity_new_brick(trees[0], trees[1], trees[2], periodic[0], periodic[1], periodic[2]));
  const std::vector<Index3> places = tree_places(*brick);

  Refinement refinement{
      .refine = refine, .places = places, .finest_level = finest_level, .blocks = brick->num_trees, .failure = nullptr};
  const Octree octree(p8est_new_ext(MPI_COMM_SELF, brick.get(), 0, 0, 1, 0, nullptr, &refinement));
  p8est_refine(octree.get(), 1, refine_quadrant, nullptr);
  if (refinement.failure) std::rethrow_exception(refinement.failure);
  p8est_balance(octree.get(), P8EST_CONNECT_FULL, nullptr);
  return read_leaves(*octree, places);
}

std::string octree_library_version() { return P4EST_VERSION; }

}  // namespace drogue::amr
