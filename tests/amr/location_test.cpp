// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "amr/forest.hpp"
#include "sample_forests.hpp"

namespace drogue::amr {
namespace {

Box cell_box(const Forest& forest, const Location& where) {
  const Vec3 centre = forest.cell_centre(where.block, where.cell);
  const Vec3 half = Vec3::Constant(0.5 * forest.spacing(forest.block(where.block).level));
  return {centre - half, centre + half};
}

/// Whether the box holds the point up to round-off of coordinates of order ten.
bool holds(const Box& box, const Vec3& point) {
  const Vec3 round_off = Vec3::Constant(1e-13);
  return Box{box.lower - round_off, box.upper + round_off}.contains(point);
}

class Locations : public testing::TestWithParam<Sample> {
 protected:
  const Forest forest_ = build(GetParam());
  const Box box_ = forest_.domain().box;
};

INSTANTIATE_TEST_SUITE_P(amr, Locations, testing::ValuesIn(samples), [](const auto& test) { return test.param.name; });

TEST_P(Locations, random_points_lie_in_the_leaf_and_cell_found) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 point = box_.lower + Vec3(unit(random), unit(random), unit(random)).cwiseProduct(box_.size());
    const auto where = forest_.locate(point);
    ASSERT_TRUE(where);
    EXPECT_EQ(forest_.block(where->block).kind, Kind::leaf);
    EXPECT_TRUE(holds(forest_.box(where->block), point));
    EXPECT_TRUE(holds(cell_box(forest_, *where), point));
  }
}

TEST_P(Locations, cell_centres_are_found_in_their_own_cell) {
  for (const int id : leaves_of(forest_)) {
    for (const Index3& cell : {Index3{0, 0, 0}, Index3{15, 15, 15}, Index3{7, 0, 15}, Index3{3, 12, 8}}) {
      const auto where = forest_.locate(forest_.cell_centre(id, cell));
      ASSERT_TRUE(where);
      EXPECT_EQ(where->block, id);
      EXPECT_EQ(where->cell, cell);
    }
  }
}

TEST_P(Locations, corners_of_blocks_lie_in_a_leaf_that_touches_them) {
  for (const int id : leaves_of(forest_)) {
    const Box box = forest_.box(id);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 point(corner & 1 ? box.upper.x() : box.lower.x(), corner & 2 ? box.upper.y() : box.lower.y(),
                       corner & 4 ? box.upper.z() : box.lower.z());
      // The far corner of the domain may have drifted out of it by round-off.
      const Vec3 inside = point.cwiseMax(box_.lower).cwiseMin(box_.upper);
      const auto where = forest_.locate(inside);
      ASSERT_TRUE(where);
      const Box found = cell_box(forest_, *where);
      for (int a = 0; a < 3; ++a) {
        const double edge = GetParam().periodic[a] ? box_.size()[a] : 0;
        const auto near = [&](double x) { return x >= found.lower[a] - 1e-12 && x <= found.upper[a] + 1e-12; };
        EXPECT_TRUE(near(inside[a]) || near(inside[a] - edge) || near(inside[a] + edge));
      }
    }
  }
}

TEST_P(Locations, points_outside_are_found_along_periodic_axes_only) {
  const Vec3 inside = box_.lower + 0.3 * box_.size();
  for (int a = 0; a < 3; ++a) {
    for (const int turns : {-3, -1, 1, 2}) {
      Vec3 point = inside;
      point[a] += turns * box_.size()[a];
      const auto where = forest_.locate(point);
      ASSERT_EQ(where.has_value(), GetParam().periodic[a]);
      if (where) {
        EXPECT_EQ(where->block, forest_.locate(inside)->block);
        EXPECT_EQ(where->cell, forest_.locate(inside)->cell);
      }
    }
    for (const double x : {std::nextafter(box_.lower[a], -1e9), std::nextafter(box_.upper[a], 1e9)}) {
      Vec3 point = inside;
      point[a] = x;
      EXPECT_EQ(forest_.locate(point).has_value(), GetParam().periodic[a]);
    }
  }
}

TEST_P(Locations, domain_corners_are_inside_and_what_is_no_number_is_not) {
  EXPECT_TRUE(forest_.locate(box_.lower));
  EXPECT_TRUE(forest_.locate(box_.upper));
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (int a = 0; a < 3; ++a) {
      Vec3 point = box_.lower + 0.5 * box_.size();
      point[a] = bad;
      EXPECT_FALSE(forest_.locate(point));
      point[a] = -bad;
      EXPECT_FALSE(forest_.locate(point));
    }
  }
  const bool wraps = GetParam().periodic == std::array{true, true, true};
  EXPECT_EQ(forest_.locate(Vec3::Constant(1e300)).has_value(), wraps);
}

TEST_P(Locations, find_wraps_and_knows_the_rim) {
  for (int level = 0; level < forest_.levels(); ++level) {
    const Index3 n = forest_.blocks_across(level);
    const BlockRange leaves = forest_.range(level, Kind::leaf);
    for (int id = leaves.begin; id < leaves.end; ++id) {
      for (int a = 0; a < 3; ++a) {
        Index3 index = forest_.block(id).index;
        const bool first = index[a] == 0;
        index[a] += 5 * n[a];
        EXPECT_EQ(forest_.find(level, index), GetParam().periodic[a] ? id : none);
        index[a] -= 8 * n[a];
        EXPECT_EQ(forest_.find(level, index), GetParam().periodic[a] ? id : none);
        if (!first || GetParam().periodic[a]) continue;
        index[a] = -1;
        ASSERT_NE(forest_.find(level, index), none);
        EXPECT_EQ(forest_.block(forest_.find(level, index)).kind, Kind::boundary);
      }
    }
  }
}

TEST(Locations, faces_belong_to_the_block_above_them) {
  const Forest forest({{{-2, -2, -2}, {6, 2, 2}}, 0.25}, 0, refine_at_random(0, 1));
  const auto where = forest.locate({2, 0, 2});
  ASSERT_TRUE(where);
  EXPECT_EQ(forest.block(where->block).index, (Index3{1, 0, 0}));
  EXPECT_EQ(where->cell, (Index3{0, 8, 15}));
}

TEST(Locations, a_trace_below_a_periodic_edge_lies_in_the_last_cell) {
  const Forest forest({{{0, 0, 0}, {4, 4, 4}}, 0.25, {true, true, true}}, 0, refine_at_random(0, 1));
  EXPECT_EQ(forest.locate({-1e-20, 4, 4 - 1e-15})->cell, (Index3{15, 0, 15}));
}

}  // namespace
}  // namespace drogue::amr
