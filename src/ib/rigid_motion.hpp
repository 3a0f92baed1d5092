// SPDX-License-Identifier: GPL-3.0-or-later
// A prescribed motion of a rigid body: a translation and a rotation about a fixed direction, as formulas of time. The
// point X of the body at rest is at
//   x(t) = p(t) + R(t) (X - P),   p(t) = P + T(t),   with the velocity   dp/dt + omega x (x - p).
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "core/expression.hpp"
#include "core/types.hpp"

namespace drogue::ib {

/// Where a rigid body is.
struct Pose {
  Vec3 pivot_at_rest = Vec3::Zero();  ///< P [m]
  Vec3 pivot = Vec3::Zero();          ///< p [m]
  Mat3 rotation = Mat3::Identity();   ///< R

  Vec3 operator()(const Vec3& at_rest) const { return pivot + rotation * (at_rest - pivot_at_rest); }
};

/// How a rigid body moves.
struct Twist {
  Vec3 pivot = Vec3::Zero();     ///< p [m]
  Vec3 velocity = Vec3::Zero();  ///< of the pivot [m/s]
  Vec3 spin = Vec3::Zero();      ///< omega [rad/s]

  Vec3 operator()(const Vec3& place) const { return velocity + spin.cross(place - pivot); }
};

struct RigidMotion {
  std::array<Expression, 3> translation;  ///< [m], functions of t
  Vec3 axis = Vec3::UnitZ();              ///< of the rotation, unit
  Vec3 pivot = Vec3::Zero();              ///< P, through which the axis passes [m]
  Expression angle;                       ///< [rad], a function of t

  bool is_still() const;
  Pose pose(double time) const;
  /// Central differences of the formulas over `step` [s] on either side: rounding costs 1e-16 of a length over the
  /// step, the third derivative a sixth of it times the step squared.
  Twist twist(double time, double step) const;
};

}  // namespace drogue::ib
