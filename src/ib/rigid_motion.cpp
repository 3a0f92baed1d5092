// SPDX-License-Identifier: GPL-3.0-or-later
#include "ib/rigid_motion.hpp"

#include <algorithm>

namespace drogue::ib {

namespace {

Vec3 value(const std::array<Expression, 3>& formula, double time) {
  return {formula[0](Vec3::Zero(), time), formula[1](Vec3::Zero(), time), formula[2](Vec3::Zero(), time)};
}

}  // namespace

bool RigidMotion::is_still() const {
  return !angle.depends_on_time() && std::ranges::none_of(translation, &Expression::depends_on_time);
}

Pose RigidMotion::pose(double time) const {
  return {pivot, pivot + value(translation, time),
          Eigen::AngleAxisd(angle(Vec3::Zero(), time), axis).toRotationMatrix()};
}

Twist RigidMotion::twist(double time, double step) const {
  const Vec3 velocity = (value(translation, time + step) - value(translation, time - step)) / (2.0 * step);
  const double spin = (angle(Vec3::Zero(), time + step) - angle(Vec3::Zero(), time - step)) / (2.0 * step);
  return {pivot + value(translation, time), velocity, spin * axis};
}

}  // namespace drogue::ib
