// SPDX-License-Identifier: GPL-3.0-or-later
#include "ib/rigid_body.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/error.hpp"
#include "fake_fluid.hpp"
#include "ib/dragged_mass.hpp"

namespace drogue::ib {
namespace {

using drogue::testing::cube_of_fine_blocks;
using drogue::testing::FakeFluid;
using drogue::testing::periodic_box;
using geometry::Shape;

constexpr double density = 1.3, dt = 0.01;
const Vec3 place(0.013, 0.004, -0.007);  // means nothing to the grid

RigidMotion moving_with(const std::string& x, const std::string& angle = "0") {
  RigidMotion motion;
  motion.translation[0] = Expression(x);
  motion.angle = Expression(angle);
  motion.pivot = place;
  return motion;
}

class Forced : public ::testing::TestWithParam<Delta> {
 protected:
  RigidBodyOptions options() const { return {.delta = GetParam(), .fluid_density = density, .body = "body"}; }
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid{forest, density};
};

/// Exact where the row sums of the dragged mass are one: not quite at edges.
TEST_P(Forced, one_pass_stops_uniform_flow) {
  struct Expectation {
    Shape shape;
    double slip;
  };
  for (const auto& [shape, slip] :
       {Expectation{geometry::sphere(place, 0.6), 0.015}, Expectation{geometry::plate(place, 0, {0.7, 0.4}), 0.15},
        Expectation{geometry::disk(place, 2, 0.8), 0.08},
        Expectation{geometry::cylinder(place, 1, 0.3, 0.8, geometry::Ends::capped), 0.04}}) {
    RigidBody body(forest, shape, moving_with("0"), options());
    fluid.fill([](const Vec3&) { return Vec3(1.0, 0.0, 0.0); });
    fluid.step(body, dt);
    EXPECT_LT(body.slip(fluid.view()).max, slip);
    EXPECT_LT(body.slip(fluid.view()).rms, 0.25 * slip);
  }
}

TEST_P(Forced, the_load_at_rest_is_the_momentum_that_the_fluid_loses) {
  RigidBody body(forest, geometry::sphere(place, 0.6), moving_with("0"), options());
  fluid.fill_at_random(5);
  const Vec3 before = fluid.momentum();
  fluid.step(body, dt);
  EXPECT_LT((fluid.momentum() - before + dt * body.load().force).norm(), 1e-6 * body.load().force.norm() * dt);
}

TEST_P(Forced, a_body_that_accelerates_with_the_fluid_feels_the_pressure_that_moves_the_fluid) {
  const double acceleration = 0.4, volume = std::numbers::pi / 6.0 * 0.6 * 0.6 * 0.6;
  RigidBody body(forest, geometry::sphere(place, 0.6), moving_with("0.2*t^2"), options());
  for (int step = 1; step <= 3; ++step) {
    fluid.fill([&](const Vec3&) { return Vec3(acceleration * step * dt, 0.0, 0.0); });
    fluid.step(body, dt);
    EXPECT_NEAR(body.load().force.x(), density * volume * acceleration, 1e-4 * density * volume * acceleration);
  }
}

TEST_P(Forced, an_accelerating_sheet_has_no_fluid_inside) {
  RigidBody body(forest, geometry::plate(place, 0, {0.5, 0.5}), moving_with("0.2*t^2"), options());
  fluid.fill([&](const Vec3&) { return Vec3(0.4 * dt, 0.0, 0.0); });
  fluid.step(body, dt);
  EXPECT_LT(body.load().force.norm(), 1e-6);
}

TEST_P(Forced, fluid_at_rest_resists_a_spinning_body) {
  RigidBody body(forest, geometry::sphere(place, 0.6), moving_with("0", "2*t"), options());
  fluid.step(body, dt);
  EXPECT_LT(body.load().torque.z(), 0.0);
  EXPECT_LT(body.load().force.norm(), 1e-3 * std::abs(body.load().torque.z()) / 0.3);
  EXPECT_LT(body.load().torque.head<2>().norm(), 1e-3 * std::abs(body.load().torque.z()));
}

TEST_P(Forced, fluid_that_spins_faster_drags_it_along_however_inclined) {
  RigidMotion motion = moving_with("0", "0.4*t^2");
  motion.axis = Vec3::UnitX();
  RigidBody body(forest, geometry::cylinder(place, 2, 0.3, 0.6, geometry::Ends::capped), motion, options());
  fluid.fill([](const Vec3& x) { return Vec3(0.0, -(x.z() - place.z()), x.y() - place.y()); });
  fluid.step(body, dt);
  EXPECT_GT(body.load().torque.x(), 0.0);
}

TEST_P(Forced, the_mean_load_forgets_what_was_taken) {
  RigidBody body(forest, geometry::sphere(place, 0.6), moving_with("0"), options());
  fluid.fill([](const Vec3&) { return Vec3(1.0, 0.0, 0.0); });
  fluid.step(body, dt);
  const double first = body.load().force.x();
  fluid.step(body, dt);
  EXPECT_NEAR(body.take_mean_load().force.x(), 0.5 * (first + body.load().force.x()), 1e-9 * first);
  EXPECT_EQ(body.take_mean_load().force, Vec3::Zero());
}

TEST_P(Forced, markers_that_meet_their_periodic_images_all_drag_the_same) {
  const amr::Forest box = periodic_box();
  const double dx = box.spacing(0);
  const auto surface = geometry::cylinder({1.0, 0.5, 0.5}, 2, 0.5, 1.0, geometry::Ends::open).sample(dx);
  Markers markers(box, GetParam(), "tube");
  markers.move_to(surface.point);
  const auto mass = mass_dragged(markers, box, surface.area, density);
  const std::size_t around = mass.size() / 16;
  for (std::size_t l = around; l < mass.size(); ++l) EXPECT_NEAR(mass[l], mass[l - around], 1e-5 * mass[l]);
}

INSTANTIATE_TEST_SUITE_P(Delta, Forced, ::testing::Values(Delta::peskin4, Delta::peskin3),
                         [](const auto& test) { return test.param == Delta::peskin4 ? "peskin4" : "peskin3"; });

TEST(MassDragged, is_that_of_the_closed_form_within_a_sheet_and_more_at_its_edges) {
  const amr::Forest forest = cube_of_fine_blocks();
  const double dx = forest.spacing(1);
  const auto surface = geometry::plate(place, 0, {20 * dx, 20 * dx}).sample(dx);
  Markers markers(forest, Delta::peskin4, "sheet");
  markers.move_to(surface.point);
  const auto exact = mass_dragged(markers, forest, surface.area, density);
  const auto sheet = mass_dragged_by_sheet(Delta::peskin4, surface.area, dx, density);
  const std::size_t middle = 10 * 20 + 10;
  EXPECT_NEAR(exact[middle], sheet[middle], 1e-3 * sheet[middle]);
  EXPECT_GT(exact[0], 1.5 * sheet[0]);
}

TEST(RigidBody, outside_the_finest_cells_is_refused) {
  const amr::Forest forest = cube_of_fine_blocks();
  EXPECT_THROW(RigidBody(forest, geometry::sphere({1.2, 0.0, 0.0}, 0.5), {}, {.body = "ball"}), InputError);
}

}  // namespace
}  // namespace drogue::ib
