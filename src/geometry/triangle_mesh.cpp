// SPDX-License-Identifier: GPL-3.0-or-later
// The solid inside a closed surface is the sum of the tetrahedra between the origin and each triangle (a, b, c), with
// signs: volume a.(b x c)/6, second moments V/20 (aa + bb + cc + ss), s = a + b + c.
#include "geometry/triangle_mesh.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <map>

#include "core/error.hpp"

namespace drogue::geometry {

namespace {

Solid centre_of_area(const TriangleMesh& mesh) {
  Solid solid;
  double total = 0.0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 &a = mesh.points[i], &b = mesh.points[j], &c = mesh.points[k];
    const double area = 0.5 * (b - a).cross(c - a).norm();
    solid.centre += area / 3.0 * (a + b + c);
    total += area;
  }
  if (total > 0.0) solid.centre /= total;
  return solid;
}

}  // namespace

bool is_closed(const TriangleMesh& mesh) {
  std::map<std::array<int, 2>, std::array<int, 2>> uses;  // of an edge: along and against the order of its points
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const int a = triangle[i], b = triangle[(i + 1) % 3];
      ++uses[{std::min(a, b), std::max(a, b)}][a < b ? 0 : 1];
    }
  }
  const std::array<int, 2>* twice_alike = nullptr;
  for (const auto& [edge, count] : uses) {
    if (count[0] + count[1] != 2) return false;
    if (count[0] != 1) twice_alike = &edge;
  }
  if (!twice_alike) return !mesh.triangles.empty();
  const Vec3& at = mesh.points[(*twice_alike)[0]];
  throw InputError(
      fmt::format("the closed surface has two triangles of opposite orientation at ({:g}, {:g}, {:g}) m; "
                  "expected all of them counter-clockwise seen from outside",
                  at.x(), at.y(), at.z()));
}

Solid solid_of(const TriangleMesh& mesh) {
  if (!is_closed(mesh)) return centre_of_area(mesh);
  Solid solid;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 &a = mesh.points[i], &b = mesh.points[j], &c = mesh.points[k], s = a + b + c;
    const double volume = a.dot(b.cross(c)) / 6.0;
    solid.volume += volume;
    first += volume / 4.0 * s;
    second += volume / 20.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  solid.centre = first / solid.volume;
  second -= solid.volume * solid.centre * solid.centre.transpose();
  solid.inertia = second.trace() * Mat3::Identity() - second;
  return solid;
}

}  // namespace drogue::geometry
