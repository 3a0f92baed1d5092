// SPDX-License-Identifier: GPL-3.0-or-later
// Generalised-alpha: order, damping, pairs, holds, and agreement with the explicit scheme.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bodies.hpp"

namespace drogue::fem {
namespace {

const NeoHookean neo_hookean(1e3, 0.3, 0.3);
/// Speed of waves along a bar, sqrt(E / rho), at a density of 1 kg/m^3.
const double bar_speed = std::sqrt(1e3);

StructureOptions implicit(double spectral_radius) {
  StructureOptions options;
  options.integrator = Integrator::implicit_scheme;
  options.spectral_radius = spectral_radius;
  return options;
}

double energy(const Structure& body) { return body.kinetic_energy() + body.elastic_energy(); }

std::vector<Vec3> copy(std::span<const Vec3> field) { return {field.begin(), field.end()}; }

double distance(std::span<const Vec3> a, std::span<const Vec3> b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

/// A bar that vibrates along itself at 3 % strain while it turns.
Structure vibrating_bar(const StructureOptions& options) {
  constexpr double length = 0.1;
  const Mesh mesh = block({length, 0.02, 0.02}, {4, 1, 1});
  Structure bar(one_solid(mesh, neo_hookean, 1.0, {}, options));
  std::vector<Vec3> v(mesh.nodes.size());
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Vec3& x = mesh.nodes[i];
    v[i] = Vec3(0.03 * bar_speed * std::sin(std::numbers::pi * x.x() / length), 0, 0) + Vec3(0, 0, 20).cross(x);
  }
  bar.set_state(mesh.nodes, v);
  return bar;
}

TEST(Implicit, converges_at_second_order) {
  const double period = 0.2 / bar_speed;
  for (const double radius : {1.0, 0.5, 0.0}) {
    const auto after_half_a_period = [&](int steps) {
      Structure bar = vibrating_bar(implicit(radius));
      for (int step = 0; step < steps; ++step) bar.advance(0.5 * period / steps, 0.0);
      return copy(bar.position());
    };
    const auto exact = after_half_a_period(3200);
    double before = 0.0;
    for (const int steps : {100, 200, 400}) {
      const double error = distance(after_half_a_period(steps), exact);
      std::printf("spectral radius %.1f, %3d steps a period: error %.3e m, order %.2f\n", radius, steps, error,
                  std::log2(before / error));
      if (before > 0.0) {
        EXPECT_NEAR(std::log2(before / error), 2.0, 0.15) << radius;
      }
      before = error;
    }
  }
}

TEST(Implicit, a_free_vibration_keeps_its_energy) {
  const double period = 0.2 / bar_speed, dt = period / 40.0;
  for (const double radius : {1.0, 0.9, 0.5}) {
    Structure bar = vibrating_bar(implicit(radius));
    const double start = energy(bar);
    double least = start, most = start;
    for (int step = 0; step < 40 * 10; ++step) {
      bar.advance(dt, 0.0);
      least = std::min(least, energy(bar));
      most = std::max(most, energy(bar));
    }
    std::printf("radius %.2f: energy %.5f, from %.5f to %.5f\n", radius, energy(bar) / start, least / start,
                most / start);
  }
}

}  // namespace
}  // namespace drogue::fem
