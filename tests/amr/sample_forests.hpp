// SPDX-License-Identifier: GPL-3.0-or-later
// Forests that the tests of this folder share: irregular refinement in bricks of several shapes.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <ostream>
#include <vector>

#include "amr/forest.hpp"

namespace drogue::amr {

/// Refines about `share` of the blocks below `finest_level`, picked by a hash of place and level.
inline RefinementCriterion refine_at_random(double share, std::uint64_t seed) {
  return [=](const Box& box, int level) {
    std::uint64_t h = seed * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(level);
    for (int a = 0; a < 3; ++a) {
      const double centre = 0.5 * (box.lower[a] + box.upper[a]);
      h = (h ^ static_cast<std::uint64_t>(std::llround(4096 * centre))) * 0xbf58476d1ce4e5b9u;
      h ^= h >> 29;
    }
    return static_cast<double>(h % 10007) < share * 10007;
  };
}

struct Sample {
  const char* name;
  Index3 trees;
  std::array<bool, 3> periodic;
  int finest_level;
  double share;
};

inline void PrintTo(const Sample& sample, std::ostream* out) { *out << sample.name; }

inline const std::vector<Sample> samples{
    {"closed_brick", {3, 2, 2}, {false, false, false}, 3, 0.25},
    {"one_tree", {1, 1, 1}, {false, false, false}, 4, 0.4},
    {"one_periodic_tree", {1, 1, 1}, {true, true, true}, 4, 0.4},
    {"one_tree_across_a_periodic_axis", {3, 1, 2}, {false, true, false}, 3, 0.3},
    {"two_trees_across_periodic_axes", {2, 2, 1}, {true, true, true}, 3, 0.3},
    {"slab", {4, 1, 1}, {false, true, true}, 3, 0.3},
    {"uniform", {4, 3, 2}, {true, false, false}, 1, 1.0},
};

/// A domain of `trees` with its lower corner at a place that binary fractions do not hit.
inline Domain brick(const Index3& trees, const std::array<bool, 3>& periodic, double coarsest = 0.1) {
  const Vec3 lower(-0.7, 0.3, 11.1);
  return {{lower, lower + block_size * coarsest * Vec3(trees[0], trees[1], trees[2])}, coarsest, periodic};
}

inline Forest build(const Sample& sample) {
  return Forest(brick(sample.trees, sample.periodic), sample.finest_level, refine_at_random(sample.share, 1));
}

inline std::vector<int> leaves_of(const Forest& forest) {
  std::vector<int> leaves;
  for (int level = 0; level < forest.levels(); ++level) {
    const BlockRange range = forest.range(level, Kind::leaf);
    for (int id = range.begin; id < range.end; ++id) leaves.push_back(id);
  }
  return leaves;
}

}  // namespace drogue::amr
