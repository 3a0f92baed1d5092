// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "geometry/surface.hpp"

namespace drogue::geometry {
namespace {

using std::numbers::pi;

double total(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Distance to the nearest other point, smallest and largest over the surface, in units of `spacing`.
std::array<double, 2> gaps(const Surface& surface, double spacing) {
  double smallest = 1e30, largest = 0.0;
  for (std::size_t i = 0; i < surface.point.size(); ++i) {
    double nearest = 1e30;
    for (std::size_t j = 0; j < surface.point.size(); ++j) {
      if (j != i) nearest = std::min(nearest, (surface.point[i] - surface.point[j]).norm());
    }
    smallest = std::min(smallest, nearest / spacing);
    largest = std::max(largest, nearest / spacing);
  }
  return {smallest, largest};
}

struct Sample {
  const char* name;
  Shape shape;
  double area;
};

const Vec3 centre(0.3, -0.2, 0.7);

const Sample samples[] = {
    {"sphere", sphere(centre, 2.0), 4.0 * pi},
    {"capped_cylinder", cylinder(centre, 0, 1.0, 3.0, Ends::capped), 3.0 * pi + 0.5 * pi},
    {"open_cylinder", cylinder(centre, 2, 1.0, 3.0, Ends::open), 3.0 * pi},
    {"plate", plate(centre, 1, {1.5, 0.8}), 1.2},
    {"disk", disk(centre, 0, 1.6), 0.64 * pi},
};

class Shapes : public testing::TestWithParam<Sample> {};

TEST_P(Shapes, areas_add_up_at_any_spacing) {
  for (double spacing : {1.0, 0.3, 0.1, 0.033}) {
    EXPECT_NEAR(total(GetParam().shape.sample(spacing).area), GetParam().area, 1e-12 * GetParam().area) << spacing;
  }
}

TEST_P(Shapes, points_are_about_the_spacing_apart) {
  const Surface surface = GetParam().shape.sample(0.08);
  const auto [smallest, largest] = gaps(surface, 0.08);
  EXPECT_GT(smallest, 0.5);
  EXPECT_LT(largest, 1.3);
  EXPECT_NEAR(static_cast<double>(surface.point.size()) * 0.08 * 0.08 / GetParam().area, 1.0, 0.1);
}

TEST_P(Shapes, lie_where_they_are_described_as_symmetric_as_the_grid) {
  const Surface surface = GetParam().shape.sample(0.1);
  EXPECT_EQ(surface.enclosed.centre, centre);
  EXPECT_EQ(GetParam().shape.centre, centre);
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (std::size_t l = 0; l < surface.point.size(); ++l) {
    const Vec3 r = surface.point[l] - centre;
    first += surface.area[l] * r;
    second += surface.area[l] * r * r.transpose();
  }
  EXPECT_LT(first.norm(), 1e-12);
  EXPECT_LT((second - Mat3(second.diagonal().asDiagonal())).norm(), 1e-12) << "no product moments";
}

TEST_P(Shapes, normals_point_out_of_what_is_enclosed) {
  const Surface surface = GetParam().shape.sample(0.1);
  EXPECT_EQ(surface.enclosed.volume > 0.0, GetParam().shape.encloses_volume);
  for (std::size_t l = 0; l < surface.point.size(); ++l) {
    ASSERT_NEAR(surface.normal[l].norm(), 1.0, 1e-12);
    const double outwards = surface.normal[l].dot(surface.point[l] - centre);
    ASSERT_EQ(outwards > 0.0, GetParam().shape.encloses_volume);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Shapes, testing::ValuesIn(samples), [](const auto& test) { return test.param.name; });

TEST(Sphere, points_lie_on_it_and_see_outwards) {
  const Surface surface = sphere(centre, 2.0).sample(0.1);
  for (std::size_t l = 0; l < surface.point.size(); ++l) {
    const Vec3 r = surface.point[l] - centre;
    ASSERT_NEAR(r.norm(), 1.0, 1e-12);
    ASSERT_LT((surface.normal[l] - r).norm(), 1e-12);
  }
  EXPECT_NEAR(surface.enclosed.volume, 4.0 / 3.0 * pi, 1e-12);
  EXPECT_NEAR(surface.enclosed.inertia(1, 1), 8.0 / 15.0 * pi, 1e-12);
}

TEST(Cylinder, turns_with_its_axis) {
  for (int axis = 0; axis < 3; ++axis) {
    const Surface surface = cylinder(centre, axis, 1.0, 3.0, Ends::open).sample(0.1);
    for (const Vec3& point : surface.point) {
      Vec3 r = point - centre;
      EXPECT_LT(std::abs(r[axis]), 1.5);
      r[axis] = 0.0;
      ASSERT_NEAR(r.norm(), 0.5, 1e-12);
    }
    const double volume = 0.75 * pi;
    EXPECT_NEAR(surface.enclosed.volume, volume, 1e-12);
    EXPECT_NEAR(surface.enclosed.inertia(axis, axis), volume * 0.25 / 2.0, 1e-12);
    EXPECT_NEAR(surface.enclosed.inertia.trace(), volume * (0.125 + 2.0 * (0.25 / 4.0 + 9.0 / 12.0)), 1e-12);
  }
}

TEST(Plate, pieces_end_at_its_edges) {
  const Surface surface = plate(Vec3::Zero(), 2, {1.0, 0.5}).sample(0.1);
  Vec3 upper = Vec3::Zero();
  for (const Vec3& point : surface.point) {
    EXPECT_EQ(point.z(), 0.0);
    upper = upper.cwiseMax(point);
  }
  EXPECT_NEAR(upper.x(), 0.45, 1e-12) << "half a spacing within the edge";
  EXPECT_NEAR(upper.y(), 0.20, 1e-12);
}

TEST(Picture, is_the_surface_seen_from_outside) {
  const Surface ball = sphere(centre, 2.0).sample(0.1);
  for (const auto& [a, b, c] : ball.picture.triangles) {
    const Vec3 middle = (ball.picture.points[a] + ball.picture.points[b] + ball.picture.points[c]) / 3.0;
    EXPECT_NEAR((middle - centre).norm(), 1.0, 0.01);
  }
}

}  // namespace
}  // namespace drogue::geometry
