// SPDX-License-Identifier: GPL-3.0-or-later
// Topology: every property is checked by brute force on block coordinates, without the links under test.
#include "amr/forest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>

#include "core/error.hpp"
#include "sample_forests.hpp"

namespace drogue::amr {
namespace {

class Forests : public testing::TestWithParam<Sample> {
 protected:
  const Forest forest_ = build(GetParam());

  /// Coordinates as the forest should name them: wrapped along periodic axes.
  Index3 wrapped(int level, Index3 index) const {
    const Index3 n = forest_.blocks_across(level);
    for (int a = 0; a < 3; ++a) {
      if (GetParam().periodic[a]) index[a] = (index[a] + n[a]) % n[a];
    }
    return index;
  }
  bool outside(int level, const Index3& index) const {
    const Index3 n = forest_.blocks_across(level);
    return std::ranges::any_of(std::array{0, 1, 2}, [&](int a) { return index[a] < 0 || index[a] >= n[a]; });
  }
  Index3 neighbour_index(const Block& block, int slot) const {
    const Index3 d = slot_offset(slot);
    return wrapped(block.level, {block.index[0] + d[0], block.index[1] + d[1], block.index[2] + d[2]});
  }
};

INSTANTIATE_TEST_SUITE_P(amr, Forests, testing::ValuesIn(samples), [](const auto& test) { return test.param.name; });

TEST_P(Forests, touching_leaves_differ_by_one_level_at_most) {
  const int finest = forest_.finest();
  const Index3 across = forest_.blocks_across(finest);
  const auto touch = [&](const Block& a, const Block& b) {
    for (int axis = 0; axis < 3; ++axis) {
      const int a0 = a.index[axis] << (finest - a.level), a1 = (a.index[axis] + 1) << (finest - a.level);
      const int b0 = b.index[axis] << (finest - b.level), b1 = (b.index[axis] + 1) << (finest - b.level);
      bool meets = false;
      const int images = GetParam().periodic[axis] ? 1 : 0;
      for (int shift = -images; shift <= images; ++shift) {
        meets |= a0 <= b1 + shift * across[axis] && b0 + shift * across[axis] <= a1;
      }
      if (!meets) return false;
    }
    return true;
  };
  int largest = 0;
  const std::vector<int> leaves = leaves_of(forest_);
  for (const int a : leaves) {
    for (const int b : leaves) {
      const int jump = forest_.block(a).level - forest_.block(b).level;
      if (jump <= largest || !touch(forest_.block(a), forest_.block(b))) continue;
      largest = jump;
    }
  }
  EXPECT_EQ(largest, GetParam().share < 1 ? 1 : 0);
}

TEST_P(Forests, leaves_fill_the_domain_once) {
  double volume = 0;
  for (const int id : leaves_of(forest_)) volume += forest_.box(id).size().prod();
  EXPECT_NEAR(volume / forest_.domain().box.size().prod(), 1, 1e-12);
  for (const int id : leaves_of(forest_)) {
    const Block& leaf = forest_.block(id);
    Index3 index = leaf.index;
    for (int level = leaf.level - 1; level >= 0; --level) {
      index = {index[0] / 2, index[1] / 2, index[2] / 2};
      const int ancestor = forest_.find(level, index);
      ASSERT_NE(ancestor, none);
      EXPECT_EQ(forest_.block(ancestor).kind, Kind::parent);
    }
  }
}

TEST_P(Forests, leaves_have_all_neighbours_of_their_level) {
  for (const int id : leaves_of(forest_)) {
    for (int slot = 0; slot < 27; ++slot) {
      const int other = forest_.block(id).neighbour[slot];
      ASSERT_NE(other, none);
      EXPECT_EQ(forest_.block(other).level, forest_.block(id).level);
      EXPECT_EQ(forest_.block(other).index, neighbour_index(forest_.block(id), slot));
    }
    EXPECT_EQ(forest_.block(id).neighbour[13], id);
  }
}

TEST_P(Forests, links_of_every_block_name_what_exists_and_nothing_else) {
  std::map<std::pair<int, Index3>, int> by_place;
  for (int id = 0; id < forest_.size(); ++id) {
    const bool is_new = by_place.emplace(std::pair(forest_.block(id).level, forest_.block(id).index), id).second;
    EXPECT_TRUE(is_new) << "two blocks at one place";
  }
  for (int id = 0; id < forest_.size(); ++id) {
    const Block& block = forest_.block(id);
    for (int slot = 0; slot < 27; ++slot) {
      const auto there = by_place.find({block.level, neighbour_index(block, slot)});
      ASSERT_EQ(block.neighbour[slot], there == by_place.end() ? none : there->second);
    }
  }
}

TEST_P(Forests, kinds_tell_where_a_block_lies) {
  for (int id = 0; id < forest_.size(); ++id) {
    const Block& block = forest_.block(id);
    EXPECT_EQ(outside(block.level, block.index), block.kind == Kind::boundary);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!GetParam().periodic[axis]) continue;
    for (int id = 0; id < forest_.size(); ++id) {
      EXPECT_GE(forest_.block(id).index[axis], 0);
      EXPECT_LT(forest_.block(id).index[axis], forest_.blocks_across(forest_.block(id).level)[axis]);
    }
  }
}

TEST_P(Forests, hosts_of_ghosts_are_leaves_that_cover_them) {
  for (int id = 0; id < forest_.size(); ++id) {
    const Block& ghost = forest_.block(id);
    if (ghost.kind != Kind::ghost) continue;
    ASSERT_NE(ghost.parent, none);
    const Block& host = forest_.block(ghost.parent);
    EXPECT_EQ(host.kind, Kind::leaf);
    EXPECT_EQ(host.level, ghost.level - 1);
    for (int a = 0; a < 3; ++a) EXPECT_EQ(host.index[a], ghost.index[a] / 2);
    EXPECT_TRUE(std::ranges::any_of(ghost.neighbour, [&](int other) {
      return other != none && forest_.block(other).kind == Kind::leaf;
    })) << "a ghost no leaf needs";
  }
}

TEST_P(Forests, children_and_parents_point_at_each_other) {
  for (int id = 0; id < forest_.size(); ++id) {
    const Block& block = forest_.block(id);
    if (block.kind == Kind::parent) {
      for (int c = 0; c < 8; ++c) {
        ASSERT_NE(block.child[c], none);
        const Block& child = forest_.block(block.child[c]);
        EXPECT_EQ(child.parent, id);
        EXPECT_EQ(child.index,
                  (Index3{2 * block.index[0] + c % 2, 2 * block.index[1] + c / 2 % 2, 2 * block.index[2] + c / 4}));
        EXPECT_TRUE(child.kind == Kind::leaf || child.kind == Kind::parent);
      }
    } else {
      EXPECT_TRUE(std::ranges::all_of(block.child, [](int child) { return child == none; }));
    }
    if (block.level == 0 || block.kind == Kind::boundary) {
      EXPECT_EQ(block.parent, none);
    } else if (block.kind != Kind::ghost) {
      ASSERT_NE(block.parent, none);
      EXPECT_EQ(forest_.block(block.parent).kind, Kind::parent);
      EXPECT_TRUE(std::ranges::count(forest_.block(block.parent).child, id) == 1);
    }
  }
}

TEST_P(Forests, boundary_blocks_reach_a_block_one_step_inward) {
  int seen = 0;
  for (int id = 0; id < forest_.size(); ++id) {
    const Block& block = forest_.block(id);
    if (block.kind != Kind::boundary) continue;
    ++seen;
    const Index3 n = forest_.blocks_across(block.level);
    int axis = 2;
    while (block.index[axis] >= 0 && block.index[axis] < n[axis]) --axis;
    Index3 offset{0, 0, 0};
    offset[axis] = block.index[axis] < 0 ? 1 : -1;
    EXPECT_NE(block.neighbour[neighbour_slot(offset[0], offset[1], offset[2])], none);
  }
  const bool closed = GetParam().periodic == std::array{true, true, true};
  EXPECT_EQ(seen == 0, closed);
}

TEST_P(Forests, ids_are_grouped_by_level_then_kind) {
  int next = 0;
  for (int level = 0; level < forest_.levels(); ++level) {
    EXPECT_EQ(forest_.range(level).begin, next);
    for (const Kind kind : {Kind::leaf, Kind::parent, Kind::ghost, Kind::boundary}) {
      const BlockRange range = forest_.range(level, kind);
      EXPECT_EQ(range.begin, next);
      for (; next < range.end; ++next) {
        EXPECT_EQ(forest_.block(next).level, level);
        EXPECT_EQ(forest_.block(next).kind, kind);
      }
    }
    EXPECT_EQ(forest_.range(level).end, next);
    EXPECT_EQ(forest_.cells(level), std::int64_t{4096} * forest_.range(level, Kind::leaf).size());
  }
  EXPECT_EQ(next, forest_.size());
  EXPECT_GT(forest_.range(forest_.finest(), Kind::leaf).size(), 0);
}

TEST_P(Forests, leaves_and_parents_follow_the_morton_curve) {
  const auto morton = [](const Index3& index) {
    std::uint64_t code = 0;
    for (int bit = 0; bit < 20; ++bit) {
      for (int a = 0; a < 3; ++a) code |= (static_cast<std::uint64_t>(index[a]) >> bit & 1) << (3 * bit + a);
    }
    return code;
  };
  for (int level = 0; level < forest_.levels(); ++level) {
    for (const Kind kind : {Kind::leaf, Kind::parent}) {
      const BlockRange range = forest_.range(level, kind);
      for (int id = range.begin + 1; id < range.end; ++id) {
        EXPECT_LT(morton(forest_.block(id - 1).index), morton(forest_.block(id).index));
      }
    }
  }
}

TEST(Forest, one_block_of_a_periodic_axis_is_its_own_neighbour) {
  const Forest forest(brick({1, 2, 1}, {true, false, true}), 0, refine_at_random(0, 1));
  ASSERT_EQ(forest.range(0, Kind::leaf).size(), 2);
  const Block& lower = forest.block(0);
  EXPECT_EQ(lower.neighbour[neighbour_slot(1, 0, 0)], 0);
  EXPECT_EQ(lower.neighbour[neighbour_slot(-1, 0, 1)], 0);
  EXPECT_EQ(lower.neighbour[neighbour_slot(1, 1, -1)], 1);
  EXPECT_EQ(forest.range(0, Kind::boundary).size(), 2);
}

TEST(Forest, lone_closed_block_is_surrounded_by_26_boundary_blocks) {
  const Forest forest(brick({1, 1, 1}, {false, false, false}), 0, refine_at_random(0, 1));
  EXPECT_EQ(forest.size(), 27);
  EXPECT_EQ(forest.range(0, Kind::boundary).size(), 26);
  EXPECT_EQ(forest.find(0, {-1, 1, -1}), forest.block(0).neighbour[neighbour_slot(-1, 1, -1)]);
  EXPECT_EQ(forest.find(0, {-2, 0, 0}), none);
  EXPECT_EQ(forest.find(0, {2, 0, 0}), none);
  EXPECT_EQ(forest.find(1, {0, 0, 0}), none);
  EXPECT_EQ(forest.find(-1, {0, 0, 0}), none);
}

TEST(Forest, balance_reaches_across_periodic_corners) {
  const Domain domain = brick({1, 1, 1}, {true, true, true});
  const Box corner{domain.box.lower, domain.box.lower + Vec3::Constant(1e-3)};
  const Forest forest(domain, 5, refine_box(corner, domain.coarsest, domain.coarsest / 32));
  ASSERT_EQ(forest.finest(), 5);
  const auto location = forest.locate(domain.box.upper - Vec3::Constant(1e-3));
  ASSERT_TRUE(location);
  EXPECT_EQ(forest.block(location->block).level, 4);
}

TEST(Forest, criterion_sees_each_block_below_the_finest_level_with_its_box) {
  const Domain domain = brick({2, 1, 1}, {false, false, false});
  std::set<std::tuple<int, double, double, double>> seen;
  const Forest forest(domain, 2, [&](const Box& box, int level) {
    EXPECT_LT(level, 2);
    EXPECT_NEAR(box.size().maxCoeff(), 1.6 / (1 << level), 1e-12);
    EXPECT_TRUE(seen.emplace(level, box.lower.x(), box.lower.y(), box.lower.z()).second);
    return true;
  });
  EXPECT_EQ(seen.size(), 2u + 16u);
  EXPECT_EQ(forest.range(2, Kind::leaf).size(), 128);
}

TEST(Forest, levels_not_used_are_not_there) {
  const Forest forest(brick({2, 2, 2}, {false, false, false}), 6, refine_at_random(0, 1));
  EXPECT_EQ(forest.levels(), 1);
}

TEST(Forest, blocks_of_two_forests_match_by_level_and_index) {
  const Domain domain = brick({2, 2, 1}, {false, true, false});
  const Forest before(domain, 3, refine_at_random(0.2, 3));
  const Forest same(domain, 3, refine_at_random(0.2, 3));
  ASSERT_EQ(before.size(), same.size());
  for (int id = 0; id < before.size(); ++id) {
    EXPECT_EQ(same.find(before.block(id).level, before.block(id).index), id);
  }
  const Forest after(domain, 3, any_of({refine_at_random(0.2, 3), refine_at_random(0.2, 4)}));
  ASSERT_GT(leaves_of(after).size(), leaves_of(before).size());
  for (const int id : leaves_of(before)) {
    const int there = after.find(before.block(id).level, before.block(id).index);
    ASSERT_NE(there, none);
    EXPECT_TRUE(after.block(there).kind == Kind::leaf || after.block(there).kind == Kind::parent);
  }
}

TEST(Forest, exceptions_of_the_criterion_reach_the_caller) {
  const auto fail = [](const Box&, int) -> bool { throw std::runtime_error("no opinion"); };
  EXPECT_THROW(Forest(brick({1, 1, 1}, {false, false, false}), 1, fail), std::runtime_error);
}

TEST(Forest, building_is_silent) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  const Forest forest(brick({2, 2, 2}, {true, false, false}), 3, refine_at_random(0.3, 1));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

std::string message_of(const Domain& domain, int finest_level) {
  try {
    const Forest forest(domain, finest_level, refine_at_random(0, 1));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Forest, domains_of_broken_root_blocks_are_refused_with_the_nearest_edge) {
  const Vec3 zero = Vec3::Zero();
  EXPECT_EQ(
      message_of({{zero, {8.5, 4, 4}}, 0.25}, 0),
      "the domain's edge along x is 8.5 m, but must be a multiple of 4 m (16 cells of 0.25 m); the nearest is 8 m");
  EXPECT_EQ(message_of({{zero, {8, 4, 1}}, 0.25}, 0),
            "the domain's edge along z is 1 m, but must be a multiple of 4 m (16 cells of 0.25 m); the nearest is 4 m");
  EXPECT_NE(message_of({{zero, {8, 4 * (1 + 3e-9), 4}}, 0.25}, 0), "no error");
  EXPECT_EQ(message_of({{zero, {8, 4 * (1 + 3e-10), 4}}, 0.25}, 0), "no error");
}

TEST(Forest, impossible_domains_and_levels_are_refused) {
  const Vec3 zero = Vec3::Zero();
  EXPECT_EQ(message_of({{zero, {8, -4, 4}}, 0.25}, 0),
            "the domain extends from 0 m to -4 m along y, but its edge must be positive");
  EXPECT_EQ(message_of({{zero, {8, 4, std::nan("")}}, 0.25}, 0),
            "the domain extends from 0 m to nan m along z, but its edge must be positive");
  EXPECT_EQ(message_of({{zero, {8, 4, 4}}, 0}, 0), "the coarsest cell edge is 0 m, but must be positive");
  EXPECT_EQ(message_of({{zero, {8, 4, 4}}, 0.25}, -1), "the finest level is -1, but must be from 0 to 18");
  EXPECT_EQ(message_of({{zero, {8, 4, 4}}, 0.25}, 19), "the finest level is 19, but must be from 0 to 18");
  EXPECT_EQ(message_of({{zero, {4e6, 4, 4}}, 0.25}, 1),
            "level 1 would have 2000000 blocks along x, but at most 524286 are possible");
}

}  // namespace
}  // namespace drogue::amr
