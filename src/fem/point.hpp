// SPDX-License-Identifier: GPL-3.0-or-later
// The unknowns of a Structure are the coordinates of its points: a node's position, or of a pair {a, b} the mean
//   x_m = s_a x_a + s_b x_b  and the difference  d = x_a - x_b,  s_a = m_a / (m_a + m_b), s_b = 1 - s_a,
// with the face masses m_a and m_b of the inertia.
#pragma once

#include <array>
#include <span>

#include "core/types.hpp"
#include "fem/loads.hpp"

namespace drogue::fem {

/// Mass that resists in a coordinate, own mass in it, and reference volume by which a tether holds it.
struct Inertance {
  double mass;    ///< [kg]
  double own;     ///< [kg]
  double volume;  ///< [m^3]
};

using Holds = std::array<const Hold*, 3>;  ///< along each axis, or nullptr

struct Point {
  int a, b;  ///< nodes; b is -1 for a single one
  double share_a, share_b;
  Inertance mean, difference;
  Vec3 weight;  ///< [N]
  Holds hold;   ///< of the mean, and of a pair's difference but for a hinge

  bool is_pair() const { return b >= 0; }
  bool is_held() const { return hold[0] || hold[1] || hold[2]; }
  bool may_turn(int axis) const { return hold[axis] == nullptr || hold[axis]->hinged; }
  Vec3 mean_of(std::span<const Vec3> field) const {
    return is_pair() ? Vec3(share_a * field[a] + share_b * field[b]) : field[a];
  }
};

}  // namespace drogue::fem
