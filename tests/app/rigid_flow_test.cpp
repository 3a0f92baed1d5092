// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies in the lattice-Boltzmann fluid, where theory says what comes out.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/case.hpp"
#include "ib/rigid_body.hpp"
#include "lbm/solver.hpp"

namespace drogue::app {
namespace {

using std::numbers::pi;

/// Cells of 1 m, steps of 0.05 s.
fluid::Specification specification(double viscosity) {
  fluid::Specification s{};
  s.density = 1.0;
  s.viscosity = viscosity;
  s.reference_velocity = 1.0;
  s.lattice_velocity = 0.05;
  return s;
}

amr::Forest box(double edge, bool periodic_y) {
  return {
      {{Vec3::Zero(), Vec3::Constant(edge)}, 1.0, {true, periodic_y, true}}, 0, [](const Box&, int) { return false; }};
}

class Retraction : public testing::TestWithParam<ib::Delta> {};

/// A sheet that slides along y = place, with a wall at rest above it and nothing below to hold the fluid: the profile
/// above is linear, and the force tells where it would reach the velocity of the sheet.
double offset_of_sheet(ib::Delta delta, double place, double viscosity) {
  constexpr double edge = 16.0, speed = 0.2;
  fluid::Specification s = specification(viscosity);
  s.face[2].type = fluid::Boundary::free_slip;
  s.face[3].type = fluid::Boundary::no_slip;
  lbm::Solver solver(box(edge, false), s);
  ib::RigidMotion motion;
  motion.translation[0] = Expression(std::to_string(speed) + "*t");
  ib::RigidBody sheet(solver.forest(), geometry::plate({8.0, place, 8.0}, 1, {edge, edge}), motion,
                      {.delta = delta, .body = "sheet"});
  while (solver.time() < 5.0 * edge * edge / (viscosity * 9.87)) solver.step(&sheet);
  const double stress = -sheet.load().force.x() / (edge * edge);
  return edge - place - viscosity * speed / stress;
}

TEST_P(Retraction, is_how_far_before_its_markers_a_surface_sheared_on_one_side_appears) {
  constexpr int places = 4;  // of the sheet between the cells
  for (double viscosity : {0.5, 2.0, 5.0}) {
    Case c{};
    c.fluid = specification(viscosity);
    c.domain.coarsest = c.finest = 1.0;
    const double expected = wall_offset(c, GetParam());
    double sum = 0.0;
    for (int i = 0; i < places; ++i)
      sum += offset_of_sheet(GetParam(), 6.0 + static_cast<double>(i) / places, viscosity);
    std::printf("tau %.3f: %.3f cells, expected %.3f\n", relaxation_time(c, 0), sum / places, expected);
    EXPECT_NEAR(sum / places, expected, 0.02) << "viscosity " << viscosity;
  }
}

INSTANTIATE_TEST_SUITE_P(Delta, Retraction, testing::Values(ib::Delta::peskin4, ib::Delta::peskin3),
                         [](const auto& test) { return test.param == ib::Delta::peskin4 ? "peskin4" : "peskin3"; });

/// 8 pi mu R^3 Omega in unbounded fluid; in the periodic box the images add 1 %. The radius is 4.5 cells.
TEST(RigidFlow, a_slowly_spinning_sphere_feels_the_torque_of_stokes) {
  constexpr double radius = 4.5, viscosity = 5.0;
  lbm::Solver solver(box(32.0, true), specification(viscosity));
  ib::RigidMotion motion;
  motion.pivot = Vec3(15.8, 16.1, 16.3);
  motion.axis = Vec3(1.0, 2.0, 2.0) / 3.0;
  motion.angle = Expression("0.02*t");
  Case c{};
  c.fluid = specification(viscosity);
  c.domain.coarsest = c.finest = 1.0;
  ib::RigidBody ball(solver.forest(), geometry::sphere(motion.pivot, 2.0 * radius), motion,
                     {.retraction = wall_offset(c, ib::Delta::peskin4), .body = "ball"});
  for (int step = 0; step < 600; ++step) solver.step(&ball);
  const double stokes = -8.0 * pi * viscosity * std::pow(radius, 3) * 0.02;
  EXPECT_NEAR(ball.load().torque.dot(motion.axis), stokes, 0.08 * std::abs(stokes));
  EXPECT_LT((ball.load().torque - ball.load().torque.dot(motion.axis) * motion.axis).norm(), 0.01 * std::abs(stokes));
  std::printf("%.3f of Stokes' torque\n", ball.load().torque.dot(motion.axis) / stokes);
}

TEST(RigidFlow, the_fluid_of_a_periodic_box_keeps_the_momentum_that_the_body_gives_it) {
  lbm::Solver solver(box(32.0, true), specification(0.5));
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
