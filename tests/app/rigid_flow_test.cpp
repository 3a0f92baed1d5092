// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies in the lattice-Boltzmann fluid, where theory says what comes out.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ib/rigid_body.hpp"
#include "lbm/solver.hpp"

namespace drogue::app {
namespace {

using std::numbers::pi;

/// Cells of 1 m, steps of 0.05 s; walls at y_min and y_max unless all is periodic.
fluid::Specification specification(double viscosity, bool walls) {
  fluid::Specification s{};
  s.density = 1.0;
  s.viscosity = viscosity;
  s.reference_velocity = 1.0;
  s.lattice_velocity = 0.05;
  if (walls) s.face[2].type = s.face[3].type = fluid::Boundary::no_slip;
  return s;
}

amr::Forest box(const Vec3& size, bool walls) {
  return {{{Vec3::Zero(), size}, 1.0, {true, !walls, true}}, 0, [](const Box&, int) { return false; }};
}

class Retraction : public testing::TestWithParam<ib::Delta> {};

/// Between a sheet and a wall that move alike nothing shears; beyond the sheet, up to a wall at rest, the profile is
/// linear, and its force tells where the fluid sees the sheet.
TEST_P(Retraction, is_how_far_before_its_markers_a_surface_sheared_on_one_side_appears) {
  constexpr double viscosity = 2.0, speed = 0.2;
  double sum = 0.0;
  constexpr int places = 4;
  for (int i = 0; i < places; ++i) {
    const double y = 6.0 + static_cast<double>(i) / places;
    fluid::Specification s = specification(viscosity, true);
    s.face[2].velocity[0] = Expression(speed);
    lbm::Solver solver(box({16, 16, 16}, true), s);
    ib::RigidMotion motion;
    motion.translation[0] = Expression(std::to_string(speed) + "*t");
    ib::RigidBody sheet(solver.forest(), geometry::plate({8.0, y, 8.0}, 1, {16.0, 16.0}), motion,
                        {.delta = GetParam(), .body = "sheet"});
    for (int step = 0; step < 5000; ++step) solver.step(&sheet);
    const double stress = -sheet.load().force.x() / (16.0 * 16.0);
    const double offset = (16.0 - y) - viscosity * speed / stress;
    EXPECT_NEAR(offset, ib::wall_offset(GetParam()), 0.05) << "at " << y;
    sum += offset;
  }
  std::printf("the wall stands %.3f cells before the markers; expected %.3f\n", sum / places,
              ib::wall_offset(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Delta, Retraction, testing::Values(ib::Delta::peskin4, ib::Delta::peskin3),
                         [](const auto& test) { return test.param == ib::Delta::peskin4 ? "peskin4" : "peskin3"; });

TEST(RigidFlow, the_fluid_of_a_periodic_box_keeps_the_momentum_that_the_body_gives_it) {
  lbm::Solver solver(box({32, 32, 32}, false), specification(0.5, false));
  ib::RigidMotion motion;
  motion.translation[0] = Expression("0.5*(1-cos(0.3*t))");
  ib::RigidBody ball(solver.forest(), geometry::sphere({15.7, 16.2, 16.0}, 10.0), motion, {.body = "ball"});
  const double before = solver.mass_and_momentum()[1];
  for (int step = 0; step < 150; ++step) solver.step(&ball);
  const double inside = pi / 6.0 * 1000.0 * motion.twist(solver.time(), 1e-3).velocity.x();
  const double given = inside - solver.time() * ball.take_mean_load().force.x();
  EXPECT_NEAR(solver.mass_and_momentum()[1] - before, given, 0.005 * given);
  EXPECT_GT(given, 1.5 * inside) << "the body drags fluid along";
}

}  // namespace
}  // namespace drogue::app
