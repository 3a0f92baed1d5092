// SPDX-License-Identifier: GPL-3.0-or-later
// Rayleigh's damping: C = a M + b K damps a mode of frequency w by the ratio a / (2 w) + b w / 2.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bodies.hpp"
#include "core/error.hpp"

namespace drogue::fem {
namespace {

constexpr double length = 0.1;
const NeoHookean material(1e3, 0.0, 0.0);  // without contraction the modes of the bar are exact
const double wave_speed = std::sqrt(1e3);
const double lowest_frequency = std::numbers::pi * wave_speed / length;

/// A free bar in its lowest axial mode, at a small strain.
Structure vibrating_bar(double mass_damping, double stiffness_damping) {
  Model model = one_solid(block({length, 0.01, 0.01}, {20, 1, 1}), material, 1.0, {}, {.dissipation = 0.0});
  model.loads.damping = mass_damping;
  model.loads.stiffness_damping = stiffness_damping;
  Structure bar(std::move(model));
  std::vector<Vec3> v(bar.position().size(), Vec3::Zero());
  for (std::size_t i = 0; i < v.size(); ++i) {
    v[i].x() = 1e-3 * wave_speed * std::sin(std::numbers::pi * bar.position()[i].x() / length);
  }
  bar.set_state(copy(bar.position()), v);
  return bar;
}

/// Damping ratio from the loss of energy over ten periods.
double damping_ratio(Structure bar) {
  const double start = energy(bar), dt = std::numbers::pi / lowest_frequency;
  for (int half_period = 0; half_period < 20; ++half_period) bar.advance(dt, 0.0);
  return std::log(start / energy(bar)) / (2.0 * 20.0 * std::numbers::pi);
}

TEST(Damping, rayleigh_damps_by_mass_and_by_stiffness) {
  constexpr double ratio = 0.01;
  EXPECT_NEAR(damping_ratio(vibrating_bar(2.0 * ratio * lowest_frequency, 0.0)) / ratio, 1.0, 0.03);
  EXPECT_NEAR(damping_ratio(vibrating_bar(0.0, 2.0 * ratio / lowest_frequency)) / ratio, 1.0, 0.03);
}

TEST(Damping, of_the_stiffness_shortens_the_sub_step_to_what_is_stable) {
  const double undamped = vibrating_bar(0.0, 0.0).stable_step();
  const double limit = 2.0 / vibrating_bar(0.0, 0.0).largest_frequency();
  for (const double share : {0.1, 1.0, 10.0}) {
    Structure bar = vibrating_bar(0.0, share * limit);
    // Of w^2 dt^2 + 2 b w^2 dt = 4.
    EXPECT_NEAR(bar.stable_step() / undamped, std::sqrt(share * share + 1.0) - share, 1e-9);
    const double start = energy(bar);
    for (int step = 0; step < 100; ++step) {
      bar.advance(0.1 / lowest_frequency, 0.0);
      ASSERT_LE(energy(bar), 1.05 * start);  // velocities stand half a sub-step behind
    }
  }
}

TEST(Damping, of_the_stiffness_leaves_momentum_and_a_slow_rotation_alone) {
  Structure bar = vibrating_bar(0.0, 1e-4);
  const Vec3 spin(0.0, 0.0, 1.0);
  std::vector<Vec3> v;
  for (const Vec3& x : bar.position()) v.push_back(spin.cross(x) + Vec3(0.3, -0.2, 0.1));
  bar.set_state(copy(bar.position()), v);
  const double start = energy(bar);
  bar.advance(1.0, 0.0);
  EXPECT_NEAR(energy(bar) / start, 1.0, 1e-5);
  Vec3 momentum = Vec3::Zero();
  for (std::size_t i = 0; i < v.size(); ++i) momentum += bar.own_mass()[i] * (bar.velocity()[i] - v[i]);
  Vec3 change = Vec3::Zero();
  for (std::size_t i = 0; i < v.size(); ++i) change += bar.own_mass()[i] * v[i];
  EXPECT_LT(momentum.norm(), 1e-10 * change.norm());
}

TEST(Damping, must_not_be_negative) { EXPECT_THROW(vibrating_bar(0.0, -1.0), InputError); }

}  // namespace
}  // namespace drogue::fem
