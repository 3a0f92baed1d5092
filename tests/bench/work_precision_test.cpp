// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/work_precision.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace drogue::bench {
namespace {

bool beats(const Point& a, const Point& b) {
  return a.seconds <= b.seconds && a.error <= b.error && (a.seconds < b.seconds || a.error < b.error);
}

TEST(WorkPrecision, the_front_is_what_nothing_beats) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> draw(1, 20);  // few values, so that there are equal ones
  std::vector<Point> points;
  for (int i = 0; i < 60; ++i) points.push_back({"", 0, 1.0 * draw(random), 1.0 * draw(random)});
  const std::vector<int> front = pareto_front(points);
  ASSERT_FALSE(front.empty());
  for (int i = 0; i < 60; ++i) {
    const bool beaten = std::ranges::any_of(points, [&](const Point& other) { return beats(other, points[i]); });
    const bool in_front = std::ranges::find(front, i) != front.end();
    const bool twin = std::ranges::any_of(
        front, [&](int f) { return points[f].seconds == points[i].seconds && points[f].error == points[i].error; });
    EXPECT_FALSE(in_front && beaten);
    EXPECT_TRUE(beaten || in_front || twin);
  }
  for (std::size_t i = 1; i < front.size(); ++i) EXPECT_LT(points[front[i - 1]].seconds, points[front[i]].seconds);
}

TEST(WorkPrecision, a_lucky_coarse_grid_is_not_recommended) {
  const std::vector<Point> points{{"lucky", 8, 1.0, 0.001}, {"lucky", 16, 8.0, 0.05},   {"lucky", 32, 64.0, 0.01},
                                  {"steady", 8, 2.0, 0.08}, {"steady", 16, 16.0, 0.02}, {"steady", 32, 99.0, 0.005}};
  EXPECT_EQ(cheapest_within(points, 0.02), 4);
  EXPECT_EQ(cheapest_within(points, 0.1), 0);
  EXPECT_FALSE(cheapest_within(points, 1e-4));
  EXPECT_FALSE(cheapest_within({}, 1.0));
}

}  // namespace
}  // namespace drogue::bench
