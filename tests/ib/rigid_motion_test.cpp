// SPDX-License-Identifier: GPL-3.0-or-later
#include "ib/rigid_motion.hpp"

#include <gtest/gtest.h>

namespace drogue::ib {
namespace {

RigidMotion swing() {
  RigidMotion motion;
  motion.translation = {Expression("0.3*sin(2*t)"), Expression(0.1), Expression("t^2")};
  motion.axis = Vec3(1.0, 2.0, -1.0).normalized();
  motion.pivot = Vec3(0.5, 0.0, -0.2);
  motion.angle = Expression("0.7*cos(3*t)");
  return motion;
}

const Vec3 points[] = {{0.5, 0.0, -0.2}, {1.0, 1.0, 1.0}, {-0.3, 0.2, 0.4}};

TEST(RigidMotion, velocity_is_the_derivative_of_the_position) {
  const RigidMotion motion = swing();
  constexpr double h = 1e-5;
  for (double time : {0.0, 0.4, 1.7}) {
    for (const Vec3& at_rest : points) {
      const Vec3 slope = (motion.pose(time + h)(at_rest) - motion.pose(time - h)(at_rest)) / (2.0 * h);
      EXPECT_LT((motion.twist(time, 1e-4)(motion.pose(time)(at_rest)) - slope).norm(), 1e-6);
    }
  }
}

TEST(RigidMotion, keeps_distances_and_handedness) {
  const Pose pose = swing().pose(0.8);
  for (const Vec3& a : points) {
    for (const Vec3& b : points) EXPECT_NEAR((pose(a) - pose(b)).norm(), (a - b).norm(), 1e-12);
  }
  EXPECT_NEAR(pose.rotation.determinant(), 1.0, 1e-12);
}

TEST(RigidMotion, turns_right_handed_about_its_pivot) {
  RigidMotion motion;
  motion.pivot = Vec3(1.0, 0.0, 0.0);
  motion.angle = Expression("pi/2*t");
  EXPECT_LT((motion.pose(1.0)(Vec3(2.0, 0.0, 3.0)) - Vec3(1.0, 1.0, 3.0)).norm(), 1e-12);
  EXPECT_LT((motion.twist(0.0, 1e-3)(Vec3(2.0, 0.0, 3.0)) - Vec3(0.0, 1.5707963267948966, 0.0)).norm(), 1e-9);
}

TEST(RigidMotion, is_still_without_time) {
  RigidMotion motion;
  EXPECT_TRUE(motion.is_still());
  motion.angle = Expression("pi/4");
  EXPECT_TRUE(motion.is_still()) << "inclined, but at rest";
  motion.translation[1] = Expression("0*t");
  EXPECT_FALSE(motion.is_still());
}

}  // namespace
}  // namespace drogue::ib
