// SPDX-License-Identifier: GPL-3.0-or-later
#include "ib/direct_forcing.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.hpp"
#include "fake_fluid.hpp"
#include "ib/dragged_mass.hpp"

namespace drogue::ib {
namespace {

using drogue::testing::cube_of_fine_blocks;
using drogue::testing::each_forced_cell;
using drogue::testing::FakeFluid;

constexpr double dx = 1.0 / 32, density = 1.3, dt = 0.01;
constexpr int side = 33;

/// A square sheet normal to x, one marker per grid spacing, at a place that means nothing to the grid.
std::vector<Vec3> sheet() {
  std::vector<Vec3> places;
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j) places.emplace_back(0.013, (j - 16) * dx + 0.004, (k - 16) * dx - 0.007);
  }
  return places;
}

Motion sheet_moving_with(const Vec3& v) {
  return [v](const fluid::FineStep&, std::span<Vec3> position, std::span<Vec3> velocity) {
    std::ranges::copy(sheet(), position.begin());
    std::ranges::fill(velocity, v);
  };
}

class ForcedSheet : public ::testing::TestWithParam<Delta> {
 protected:
  DirectForcing forcing(const Vec3& v, int iterations = 1) {
    const std::vector<double> area(side * side, dx * dx);
    return {forest,
            {GetParam(), iterations, "sheet"},
            mass_dragged_by_sheet(GetParam(), area, dx, density),
            sheet_moving_with(v)};
  }
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid{forest, density};
};

TEST_P(ForcedSheet, a_uniform_force_on_a_sheet_changes_its_velocity_by_the_sum_of_squares) {
  Markers markers(forest, GetParam(), "sheet");
  markers.move_to(sheet());
  fluid::ForceField f(forest);
  const Vec3 per_area(2.0, -1.0, 0.5);
  markers.spread(std::vector<Vec3>(side * side, per_area * dx * dx), f);
  std::vector<Vec3> interpolated(side * side);
  markers.interpolate(f, interpolated);
  const Vec3& middle = interpolated[side * side / 2];
  EXPECT_LT((middle - per_area * sum_phi_squared(GetParam()) / dx).norm(), 1e-6 * middle.norm());
}

TEST_P(ForcedSheet, one_pass_brings_uniform_flow_to_the_velocity_of_the_sheet) {
  const Vec3 v(0.3, -0.2, 0.1);
  fluid.fill([](const Vec3&) { return Vec3(1.0, 0.5, 0.0); });
  DirectForcing hook = forcing(v);
  fluid.step(hook, dt);
  Markers markers(forest, GetParam(), "probe");
  markers.move_to(sheet());
  std::vector<Vec3> u(side * side);
  markers.interpolate(fluid.view(), u);
  for (int k = 4; k < side - 4; ++k) {
    for (int j = 4; j < side - 4; ++j) EXPECT_LT((u[k * side + j] - v).norm(), 1e-6);
  }
}

TEST_P(ForcedSheet, the_body_feels_what_the_fluid_loses) {
  fluid.fill_at_random(21);
  const Vec3 before = fluid.momentum();
  DirectForcing hook = forcing(Vec3(0.5, 0, 0));
  fluid.step(hook, dt);
  EXPECT_LT((fluid.momentum() - before + dt * hook.force()).norm(), 1e-6 * hook.force().norm() * dt);

  Vec3 spread_force = Vec3::Zero();
  each_forced_cell(forest, fluid.force(), [&](const Vec3&, const Vec3& f) { spread_force += f * fluid.cell_volume(); });
  EXPECT_LT((spread_force + hook.force()).norm(), 1e-6 * hook.force().norm());
}

TEST_P(ForcedSheet, further_passes_leave_less_slip) {
  double last = 1e30;
  for (int iterations : {1, 2, 4, 8}) {
    fluid.fill_at_random(22);
    DirectForcing hook = forcing(Vec3(0.5, 0, 0), iterations);
    fluid.step(hook, dt);
    EXPECT_LT(hook.slip(fluid.view()).rms, 0.95 * last);
    last = hook.slip(fluid.view()).rms;
  }
}

TEST_P(ForcedSheet, repeated_steps_in_a_fluid_without_dynamics_bring_the_slip_to_nothing) {
  fluid.fill_at_random(23);
  DirectForcing hook = forcing(Vec3(0.5, 0, 0));
  double last = 1e30;
  for (int step = 0; step < 50; ++step) {
    fluid.step(hook, dt);
    ASSERT_LT(hook.slip(fluid.view()).rms, last);
    last = hook.slip(fluid.view()).rms;
  }
  EXPECT_LT(last, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Delta, ForcedSheet, ::testing::Values(Delta::peskin4, Delta::peskin3),
                         [](const auto& test) { return test.param == Delta::peskin4 ? "peskin4" : "peskin3"; });

TEST(DirectForcing, rejects_no_passes_and_markers_without_mass) {
  const amr::Forest forest = cube_of_fine_blocks();
  EXPECT_THROW(DirectForcing(forest, {Delta::peskin4, 0, "sheet"}, {1.0}, sheet_moving_with(Vec3::Zero())), InputError);
  EXPECT_THROW(DirectForcing(forest, {Delta::peskin4, 1, "sheet"}, {1.0, 0.0}, sheet_moving_with(Vec3::Zero())),
               InputError);
}

TEST(DirectForcing, a_second_body_sees_the_forces_of_the_first) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest, density);
  fluid.fill([](const Vec3&) { return Vec3(1.0, 0.0, 0.0); });
  const std::vector<double> mass(1, density * std::pow(dx / sum_phi_squared(Delta::peskin4), 3));
  const auto at_origin = [](const fluid::FineStep&, std::span<Vec3> x, std::span<Vec3> v) {
    x[0] = v[0] = Vec3::Zero();
  };
  DirectForcing first(forest, {Delta::peskin4, 1, "first"}, mass, at_origin);
  DirectForcing second(forest, {Delta::peskin4, 1, "second"}, mass, at_origin);
  struct Both : fluid::FineStepHook {
    std::array<fluid::FineStepHook*, 2> hooks;
    void on_fine_step(fluid::FineStep& step) override {
      for (auto* hook : hooks) hook->on_fine_step(step);
    }
  } both;
  both.hooks = {&first, &second};
  fluid.step(both, dt);
  EXPECT_GT(first.force().x(), 0.0);
  EXPECT_LT(std::abs(second.force().x()), 1e-6 * first.force().x());
}

}  // namespace
}  // namespace drogue::ib
