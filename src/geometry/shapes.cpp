// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geometry/surface.hpp"

namespace drogue::geometry {

namespace {

using std::numbers::pi;

/// Distance from the axis and place along it [m].
using ProfilePoint = Eigen::Vector2d;
/// A curve over 0 <= s <= 1 with the outside on its right: a sphere's runs from the lower pole to the upper.
using Profile = std::function<ProfilePoint(double s)>;

constexpr int picture_segments = 96;

int pieces(double length, double spacing) { return std::max(1, static_cast<int>(std::lround(length / spacing))); }

/// Adds what the profile sweeps around the z axis, as rings of nearly square pieces. Their number around is a multiple
/// of four, so that a body is as symmetric as the grid.
void revolve(const Profile& profile, int rings, Surface& surface) {
  for (int ring = 0; ring < rings; ++ring) {
    const ProfilePoint begin = profile(static_cast<double>(ring) / rings), middle = profile((ring + 0.5) / rings);
    const ProfilePoint along = profile((ring + 1.0) / rings) - begin;
    const int around = 4 * pieces(2.0 * pi * middle[0], 4.0 * along.norm());
    const double area = pi * (2.0 * begin[0] + along[0]) * along.norm() / around;
    for (int piece = 0; piece < around; ++piece) {
      const double angle = 2.0 * pi * (piece + 0.5) / around;
      const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
      surface.point.push_back(middle[0] * out + middle[1] * Vec3::UnitZ());
      surface.area.push_back(area);
      surface.normal.push_back((along[1] * out - along[0] * Vec3::UnitZ()).normalized());
    }
  }
}

void revolve_picture(const Profile& profile, int rings, TriangleMesh& picture) {
  const int first = static_cast<int>(picture.points.size());
  for (int ring = 0; ring <= rings; ++ring) {
    const ProfilePoint p = profile(static_cast<double>(ring) / rings);
    for (int i = 0; i < picture_segments; ++i) {
      const double angle = 2.0 * pi * i / picture_segments;
      picture.points.emplace_back(p[0] * std::cos(angle), p[0] * std::sin(angle), p[1]);
    }
  }
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < picture_segments; ++i) {
      const int a = first + ring * picture_segments + i;
      const int b = first + ring * picture_segments + (i + 1) % picture_segments;
      picture.triangles.push_back({a, b, b + picture_segments});
      picture.triangles.push_back({a, b + picture_segments, a + picture_segments});
    }
  }
}

struct Part {
  Profile profile;
  double length;  ///< of the curve [m]
};

Surface revolution(const std::vector<Part>& parts, double spacing) {
  Surface surface;
  for (const auto& [profile, length] : parts) {
    revolve(profile, pieces(length, spacing), surface);
    revolve_picture(profile, pieces(length, spacing), surface.picture);
  }
  return surface;
}

/// From a surface around the origin with its axis along z to its place; the axes keep their cyclic order.
Surface placed(Surface surface, int axis, const Vec3& centre) {
  Mat3 turn = Mat3::Zero();
  for (int a = 0; a < 3; ++a) turn((axis + 1 + a) % 3, a) = 1.0;
  for (Vec3& p : surface.point) p = centre + turn * p;
  for (Vec3& n : surface.normal) n = turn * n;
  for (Vec3& p : surface.picture.points) p = centre + turn * p;
  surface.enclosed.centre = centre;
  surface.enclosed.inertia = turn * surface.enclosed.inertia * turn.transpose();
  return surface;
}

void scale_to(double area, Surface& surface) {
  const double sum = std::accumulate(surface.area.begin(), surface.area.end(), 0.0);
  for (double& a : surface.area) a *= area / sum;
}

Part straight(const ProfilePoint& from, const ProfilePoint& to) {
  return {[=](double s) -> ProfilePoint { return from + s * (to - from); }, (to - from).norm()};
}

}  // namespace

Shape sphere(const Vec3& centre, double diameter) {
  const double r = 0.5 * diameter;
  const auto sample = [=](double spacing) {
    const Profile meridian = [r](double s) { return ProfilePoint(r * std::sin(pi * s), -r * std::cos(pi * s)); };
    Surface surface = revolution({{meridian, pi * r}}, spacing);
    scale_to(4.0 * pi * r * r, surface);
    surface.enclosed.volume = 4.0 / 3.0 * pi * r * r * r;
    surface.enclosed.inertia = 0.4 * surface.enclosed.volume * r * r * Mat3::Identity();
    return placed(std::move(surface), 0, centre);
  };
  return {.centre = centre, .reference_area = pi * r * r, .width = diameter, .sample = sample};
}

Shape cylinder(const Vec3& centre, int axis, double diameter, double length, Ends ends) {
  const double r = 0.5 * diameter, half = 0.5 * length;
  const auto sample = [=](double spacing) {
    std::vector<Part> parts{straight({r, -half}, {r, half})};
    if (ends == Ends::capped) {
      parts.push_back(straight({0.0, -half}, {r, -half}));
      parts.push_back(straight({r, half}, {0.0, half}));
    }
    Surface surface = revolution(parts, spacing);
    const double volume = pi * r * r * length, across = volume * (r * r / 4.0 + length * length / 12.0);
    surface.enclosed.volume = volume;
    surface.enclosed.inertia = Vec3(across, across, 0.5 * volume * r * r).asDiagonal();
    return placed(std::move(surface), axis, centre);
  };
  return {.centre = centre,
          .reference_area = diameter * length,
          .width = diameter,
          .span = ends == Ends::open ? length : 0.0,
          .span_axis = axis,
          .sample = sample};
}

Shape plate(const Vec3& centre, int normal, const std::array<double, 2>& size) {
  const auto sample = [=](double spacing) {
    Surface surface;
    const int rows = pieces(size[0], spacing), columns = pieces(size[1], spacing);
    const auto at = [&](double s, double t) { return Vec3((s - 0.5) * size[0], (t - 0.5) * size[1], 0.0); };
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) surface.point.push_back(at((i + 0.5) / rows, (j + 0.5) / columns));
    }
    surface.area.assign(surface.point.size(), size[0] * size[1] / (rows * columns));
    surface.normal.assign(surface.point.size(), Vec3::UnitZ());
    surface.picture = {{at(0, 0), at(1, 0), at(1, 1), at(0, 1)}, {{0, 1, 2}, {0, 2, 3}}};
    return placed(std::move(surface), normal, centre);
  };
  return {.centre = centre,
          .reference_area = size[0] * size[1],
          .width = std::min(size[0], size[1]),
          .encloses_volume = false,
          .sample = sample};
}

Shape disk(const Vec3& centre, int normal, double diameter) {
  const double r = 0.5 * diameter;
  const auto sample = [=](double spacing) {
    return placed(revolution({straight({r, 0.0}, {0.0, 0.0})}, spacing), normal, centre);
  };
  return {
      .centre = centre, .reference_area = pi * r * r, .width = diameter, .encloses_volume = false, .sample = sample};
}

}  // namespace drogue::geometry
