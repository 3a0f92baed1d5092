// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/plane_stress.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "fem/hex_topology.hpp"

namespace drogue::fem {
namespace {

/// Columns: mean of the four edges along each parent direction, the thickness last.
Mat3 edges(const std::array<int, 8>& element, int thickness, std::span<const Vec3> x) {
  Mat3 mean = Mat3::Zero();
  for (int d = 0; d < 3; ++d) {
    for (const auto& [first, last] : hex_edge[(thickness + 1 + d) % 3]) {
      mean.col(d) += 0.25 * (x[element[last]] - x[element[first]]);
    }
  }
  return mean;
}

Tensor<double> diagonal(double a, double b, double c) { return {{{a, 0.0, 0.0}, {0.0, b, 0.0}, {0.0, 0.0, c}}}; }

}  // namespace

double plane_stress_thickness(const Material& material, double a, double b) {
  const auto solve = [&](const auto& law) {
    constexpr double smallest = 1e-6;
    double t = 1.0;
    for (int iteration = 0; iteration < 100; ++iteration) {  // Newton's method, by at most half the thickness at a time
      const Tensor<double> f = diagonal(a, b, t);
      const double stress = law.stress(f)(2, 2);
      const double slope = law.tangent(f)(diagonal(0.0, 0.0, 1.0))(2, 2);
      const double change = slope > 0.0 ? -stress / slope : stress > 0.0 ? -0.5 * t : 0.5 * t;
      t += std::clamp(change, -0.5 * t, 0.5 * t);
      if (std::abs(change) < 1e-13 * t) return t;
      if (t < smallest) return 0.0;
    }
    return t;
  };
  return std::visit(solve, material);
}

SheetStretch sheet_stretch(const std::array<int, 8>& element, int thickness, std::span<const Vec3> reference_position,
                           std::span<const Vec3> x) {
  const Mat3 reference = edges(element, thickness, reference_position);
  const Mat3 f = edges(element, thickness, x) * reference.inverse();
  Mat3 frame;  // of the undeformed mid-surface, its normal last
  frame.col(2) = reference.col(0).cross(reference.col(1)).normalized();
  frame.col(0) = reference.col(0).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  const Mat3 g = f * frame;
  const double aa = g.col(0).squaredNorm(), bb = g.col(1).squaredNorm(), ab = g.col(0).dot(g.col(1));
  const double mean = 0.5 * (aa + bb), half_range = std::hypot(0.5 * (aa - bb), ab);
  const std::array<double, 2> in_plane{std::sqrt(mean - half_range), std::sqrt(mean + half_range)};
  return {g.determinant() / (in_plane[0] * in_plane[1]), in_plane};
}

}  // namespace drogue::fem
