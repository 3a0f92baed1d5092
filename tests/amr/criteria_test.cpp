// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>

#include "amr/forest.hpp"
#include "core/error.hpp"
#include "sample_forests.hpp"

namespace drogue::amr {
namespace {

const Domain tunnel{{{-2, -2, -2}, {6, 2, 2}}, 0.25};

TEST(RefineBox, cells_inside_reach_the_spacing_and_no_finer) {
  const Box region{{-0.3, -0.45, -0.45}, {0.9, 0.45, 0.45}};
  for (const double spacing : {0.25, 0.125, 0.1, 1.0 / 64}) {
    const Forest forest(tunnel, 6, refine_box(region, 0.25, spacing));
    EXPECT_EQ(forest.spacing(forest.finest()), std::exp2(std::floor(std::log2(spacing))));
    for (const int id : leaves_of(forest)) {
      if (forest.box(id).overlaps(region)) {
        EXPECT_EQ(forest.block(id).level, forest.finest());
      }
    }
  }
}

TEST(RefineBox, spacing_met_up_to_round_off_is_met) {
  const Box region{{-1, -1, -1}, {1, 1, 1}};
  EXPECT_EQ(Forest(tunnel, 6, refine_box(region, 0.25, 0.125 * (1 - 1e-12))).finest(), 1);
  EXPECT_EQ(Forest(tunnel, 6, refine_box(region, 0.25, 0.125 * (1 - 1e-6))).finest(), 2);
}

TEST(RefineBox, region_made_of_blocks_refines_just_these_up_to_round_off) {
  const Domain domain = brick({4, 4, 4}, {false, false, false});
  for (const double round_off : {-1e-13, 0.0, 1e-13}) {
    const Vec3 lower = domain.box.lower + Vec3::Constant(1.6 - round_off);
    const Forest forest(domain, 1, refine_box({lower, lower + Vec3(3.2, 1.6, 1.6)}, 0.1, 0.05));
    EXPECT_EQ(forest.range(1, Kind::leaf).size(), 2 * 8);
  }
}

TEST(RefineBox, flat_region_on_a_face_refines_both_sides) {
  const Box sheet{{0, -0.4, -0.4}, {0, 0.4, 0.4}};
  const Forest forest(tunnel, 4, refine_box(sheet, 0.25, 1.0 / 64));
  for (const double x : {-0.01, 0.01}) {
    EXPECT_EQ(forest.block(forest.locate({x, 0.1, 0.1})->block).level, 4);
  }
}

TEST(RefineBox, paper_domain_is_built_quickly) {
  // Families of eight blocks of 0.25 m on level 4: three by four by four.
  const Box around_plate{{-0.5, -0.75, -0.75}, {1, 0.75, 0.75}};
  double fastest = 1e9;
  for (int run = 0; run < 5; ++run) {
    const auto start = std::chrono::steady_clock::now();
    const Forest forest(tunnel, 4, refine_box(around_plate, 0.25, 1.0 / 64));
    fastest = std::min(fastest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    EXPECT_EQ(forest.range(4, Kind::leaf).size(), 8 * 48);
    EXPECT_EQ(forest.blocks_across(0), (Index3{2, 1, 1}));
  }
#ifdef NDEBUG
  EXPECT_LT(fastest, 0.1);
#endif
}

TEST(RefineNear, blocks_are_refined_where_a_swept_point_is_near) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3> points;
  for (int i = 0; i < 37; ++i) points.emplace_back(-1 + unit(random), 2 * unit(random) - 1, 2 * unit(random) - 1);
  for (const Vec3& sweep : {Vec3(0, 0, 0), Vec3(1.5, 0, 0), Vec3(0.7, -0.3, 0.2)}) {
    for (const double distance : {0.0, 0.05, 0.3}) {
      const auto criterion = refine_near(points, distance, sweep, 0.25, 0.125);
      for (int i = 0; i < 150; ++i) {
        const Vec3 lower(-2 + 4 * unit(random), -2 + 4 * unit(random), -2 + 4 * unit(random));
        const Box box{lower, lower + Vec3::Constant(0.4)};
        // The path by sampling: what it hits must be refined, and what it misses by far must not.
        double nearest = 1e9;
        for (const Vec3& point : points) {
          for (int s = 0; s <= 50; ++s) {
            const Vec3 p = point + s / 50.0 * sweep;
            const Vec3 gap = (box.lower - p).cwiseMax(p - box.upper).cwiseMax(0);
            nearest = std::min(nearest, gap.maxCoeff());
          }
        }
        const double sampling = sweep.lpNorm<Eigen::Infinity>() / 100;
        if (nearest <= distance) {
          EXPECT_TRUE(criterion(box, 0));
        }
        if (nearest > distance + sampling) {
          EXPECT_FALSE(criterion(box, 0));
        }
        EXPECT_FALSE(criterion(box, 1));
      }
    }
  }
}

TEST(RefineNear, points_need_not_outlive_the_criterion) {
  auto points = std::make_unique<std::vector<Vec3>>(3, Vec3(0, 0, 0));
  const auto criterion = refine_near(*points, 0.1, Vec3::Zero(), 0.25, 0.125);
  points.reset();
  EXPECT_TRUE(criterion({{-1, -1, -1}, {1, 1, 1}}, 0));
  EXPECT_FALSE(criterion({{0.2, -1, -1}, {1, 1, 1}}, 0));
}

TEST(RefineNear, no_points_refine_nothing) {
  EXPECT_FALSE(refine_near({}, 1, Vec3::Zero(), 0.25, 0.125)({{-1, -1, -1}, {1, 1, 1}}, 0));
}

TEST(AnyOf, refines_where_one_of_several_criteria_does) {
  const Box left{{-2, -2, -2}, {-1, 2, 2}}, right{{5, -2, -2}, {6, 2, 2}};
  const auto criterion = any_of({refine_box(left, 0.25, 0.125), refine_box(right, 0.25, 0.0625)});
  EXPECT_TRUE(criterion(left, 0));
  EXPECT_FALSE(criterion(left, 1));
  EXPECT_TRUE(criterion(right, 1));
  EXPECT_FALSE(criterion({{0, 0, 0}, {1, 1, 1}}, 0));
  EXPECT_FALSE(any_of({})(left, 0));
}

TEST(Criteria, spacing_must_be_positive) {
  try {
    refine_box(tunnel.box, 0.25, -0.1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "refinement from a cell edge of 0.25 m to -0.1 m was asked for, but both must be positive");
  }
  EXPECT_THROW(refine_near({}, 1, Vec3::Zero(), 0.25, 0), InputError);
}

}  // namespace
}  // namespace drogue::amr
