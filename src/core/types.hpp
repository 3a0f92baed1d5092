// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors and boxes used everywhere. Physical quantities are SI and double precision.
#pragma once

#include <Eigen/Core>
#include <array>

namespace drogue {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Index3 = std::array<int, 3>;

/// Axis-aligned box [m].
struct Box {
  Vec3 lower = Vec3::Zero();
  Vec3 upper = Vec3::Zero();

  bool contains(const Vec3& p) const {
    return (p.array() >= lower.array()).all() && (p.array() <= upper.array()).all();
  }
  bool overlaps(const Box& other) const {
    return (lower.array() < other.upper.array()).all() && (other.lower.array() < upper.array()).all();
  }
  Vec3 size() const { return upper - lower; }
};

}  // namespace drogue
