// SPDX-License-Identifier: GPL-3.0-or-later
// Whether surfaces pass through each other.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "fem/structure.hpp"

namespace drogue::fem {

/// Whether the way between two points leads through a triangle.
inline bool crosses(const Vec3& from, const Vec3& to, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto volume = [](const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    return (q - p).cross(r - p).dot(s - p);
  };
  if (volume(a, b, c, from) * volume(a, b, c, to) >= 0.0) return false;
  const double u = volume(from, to, a, b), v = volume(from, to, b, c), w = volume(from, to, c, a);
  return (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
}

/// How often edges of triangles and halves of quadrilaterals pass through others, of one body or of several.
inline int crossings(std::span<const Structure* const> bodies) {
  std::vector<Vec3> x;
  std::vector<std::array<int, 3>> faces;
  for (const Structure* body : bodies) {
    const int first = static_cast<int>(x.size());
    x.insert(x.end(), body->position().begin(), body->position().end());
    for (const auto& [a, b, c] : body->mesh().triangles) faces.push_back({first + a, first + b, first + c});
    for (const auto& [a, b, c, d] : body->mesh().quadrilaterals) {
      faces.push_back({first + a, first + b, first + c});
      faces.push_back({first + a, first + c, first + d});
    }
  }
  int count = 0;
  for (const auto& face : faces) {
    for (const auto& other : faces) {
      for (int k = 0; k < 3; ++k) {
        const int from = face[k], to = face[(k + 1) % 3];
        if (std::ranges::find(other, from) != other.end() || std::ranges::find(other, to) != other.end()) continue;
        count += crosses(x[from], x[to], x[other[0]], x[other[1]], x[other[2]]);
      }
    }
  }
  return count;
}

}  // namespace drogue::fem
