// SPDX-License-Identifier: GPL-3.0-or-later
#include "fsi/coupling.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cstring>

#include "../core/memory_archive.hpp"
#include "bodies.hpp"
#include "core/error.hpp"
#include "fem/thin_solid.hpp"
#include "ib/direct_forcing.hpp"
#include "ib/dragged_mass.hpp"

namespace drogue::fsi {
namespace {

using namespace drogue::testing;

constexpr double dx = 1.0 / 32, dt = 2e-3;

/// Density of a plate whose excess mass is `ratio` times the fluid mass it drags, if there is one.
double density_for(double ratio, double spacing, double thickness) {
  return fluid_density * std::max(0.0, 1.0 + ratio * dragged_over_displaced(spacing, thickness));
}

class MassRatio : public ::testing::TestWithParam<double> {};

TEST_P(MassRatio, momentum_of_fluid_and_solid_is_conserved) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest, fluid_density);
  fluid.fill_at_random(31);
  fem::Structure solid = plate({.density = density_for(GetParam(), dx, 0.01)});
  add_velocity(solid, random_vectors(solid.position().size(), 0.5, 32));
  Coupling coupling(solid, forest, coupled());
  const CoupledPoints points = couple_points(solid, ib::Delta::peskin4, dx, fluid_density, "plate");

  const auto momentum_of_solid = [&] {
    Vec3 sum = Vec3::Zero();
    for (int p = 0; p < points.size(); ++p) sum += points.excess_mass[p] * solid.mean_velocity(p);
    return sum;
  };
  const Vec3 before = fluid.momentum() + momentum_of_solid();
  for (int step = 0; step < 10; ++step) {
    const Vec3 fluid_before = fluid.momentum();
    fluid.step(coupling, dt);
    const Vec3 given = fluid.momentum() - fluid_before;
    EXPECT_LT((given + dt * coupling.last().force).norm(), 1e-7);
  }
  // Floats of order one in 2 m^2 x 0.1 m of cells that were forced.
  EXPECT_LT((fluid.momentum() + momentum_of_solid() - before).norm(), 1e-7 * std::max(1.0, momentum_of_solid().norm()));
}

TEST_P(MassRatio, slip_decays_and_nothing_grows) {
  const amr::Forest forest = periodic_box();
  FakeFluid fluid(forest, fluid_density);
  fluid.fill_at_random(33);
  fem::Structure solid =
      plate({.density = density_for(GetParam(), 2 * dx, 0.02), .thickness = 0.02, .elements = 8}, Vec3(1, 0.5, 0.5));
  Coupling coupling(solid, forest, coupled());
  double first_slip = 0.0;
  for (int step = 0; step < 300; ++step) {
    fluid.step(coupling, dt);
    if (step == 0) first_slip = coupling.last().slip_before;
    ASSERT_LT(fluid.max_speed(), 4.0) << step;
  }
  EXPECT_LT(coupling.last().slip_before, 0.2 * first_slip);
}

INSTANTIATE_TEST_SUITE_P(ExcessOverDragged, MassRatio, ::testing::Values(-1.0, 0.0, 1.0, 1000.0), [](const auto& test) {
  return test.param < 0.0 ? "massless" : std::to_string(static_cast<int>(test.param)) + "_times";
});

TEST(Coupling, an_infinitely_heavy_solid_is_direct_forcing) {
  const amr::Forest forest = cube_of_fine_blocks();
  const Vec3 v(0.4, -0.1, 0.2);
  FakeFluid fluid(forest, fluid_density), forced(forest, fluid_density);
  fluid.fill_at_random(34);
  forced.fill_at_random(34);
  fem::Structure solid = plate({.density = density_for(1e9, dx, 0.01)});
  add_velocity(solid, std::vector<Vec3>(solid.position().size(), v));
  Coupling coupling(solid, forest, coupled());

  const auto& mesh = solid.mesh();
  const auto pairs = fem::thickness_pairs(mesh, dx);
  const auto motion = [&](const fluid::FineStep&, std::span<Vec3> position, std::span<Vec3> velocity) {
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      position[p] = 0.5 * (mesh.nodes[pairs[p][0]] + mesh.nodes[pairs[p][1]]);
      velocity[p] = v;
    }
  };
  const auto mass = ib::mass_dragged_by_sheet(ib::Delta::peskin4, fem::pair_areas(mesh, pairs), dx, fluid_density);
  ib::DirectForcing forcing(forest, {ib::Delta::peskin4, 1, "sheet"}, mass, motion);
  fluid.step(coupling, dt);
  forced.step(forcing, dt);
  EXPECT_LT((coupling.last().force - forcing.force()).norm(), 1e-6 * forcing.force().norm());
  ASSERT_EQ(fluid.force().opened().size(), forced.force().opened().size());
  for (int id : fluid.force().opened()) {
    for (int i = 0; i < fluid::ForceField::block_floats; ++i) {
      ASSERT_NEAR(fluid.force().block(id)[i], forced.force().block(id)[i], 1e-6 * fluid_density / dt);
    }
  }
}

TEST(Coupling, a_stress_free_plate_of_the_fluids_density_is_carried_without_force) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest, fluid_density);
  const Vec3 u(1.0, 0.5, -0.25);  // exact in float
  fluid.fill([&](const Vec3&) { return u; });
  fem::Structure solid = plate({});
  Coupling coupling(solid, forest, coupled());
  const Vec3 start = solid.mean_position(0);
  for (int step = 0; step < 5; ++step) fluid.step(coupling, dt);
  EXPECT_LT((solid.mean_position(0) - start - 5 * dt * u).norm(), 1e-9);
  EXPECT_LT(coupling.last().force.norm(), 1e-6 * fluid_density * 0.25 * dx / dt);
}

TEST(Coupling, a_held_plate_stops_the_fluid_and_its_holds_bear_the_drag) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest, fluid_density);
  fluid.fill([](const Vec3&) { return Vec3(1, 0, 0); });
  fem::Structure solid = plate({.holds = {{.nodes = all_nodes(16), .rigid = true}}});
  Coupling coupling(solid, forest, coupled());
  fluid.step(coupling, dt);
  const Vec3 drag = fluid_density * 0.25 * dx * 8.0 / 3.0 / dt * Vec3::UnitX();
  EXPECT_LT((coupling.last().force - drag).norm(), 1e-6 * drag.norm());
  EXPECT_LT((solid.reaction() + drag).norm(), 1e-6 * drag.norm());
  EXPECT_EQ(coupling.last().slip_before, 1.0);
  // Slip is left only near the edges: there a marker has neighbours on one side, and half the gain.
  EXPECT_LT(coupling.slip(fluid.view())[1], 0.25);
}

TEST(Coupling, slip_is_that_of_the_points_along_one_normal) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest, fluid_density);
  fluid.fill([](const Vec3&) { return Vec3(0.5, 0.25, 0); });
  fem::Structure solid = plate({.holds = {{.nodes = all_nodes(16), .rigid = true}}});
  Coupling coupling(solid, forest, coupled());
  EXPECT_EQ(coupling.slip(fluid.view()), (std::array{0.0, 0.0}));  // no step yet
  FakeFluid untouched = FakeFluid(forest, fluid_density);
  untouched.fill([](const Vec3&) { return Vec3(0.5, 0.25, 0); });
  fluid.step(coupling, dt);
  const auto [along, full] = coupling.slip(untouched.view());
  EXPECT_NEAR(along, 0.5, 1e-6);
  EXPECT_NEAR(full, Vec3(0.5, 0.25, 0).norm(), 1e-6);
}

TEST(Coupling, the_mean_force_is_over_the_time_since_it_was_taken) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest, fluid_density);
  fluid.fill_at_random(35);
  fem::Structure solid = plate({});
  Coupling coupling(solid, forest, coupled());
  EXPECT_EQ(coupling.take_mean_force(), Vec3::Zero());
  Vec3 impulse = Vec3::Zero();
  for (double step : {dt, 2 * dt, 0.5 * dt}) {
    fluid.step(coupling, step);
    impulse += step * coupling.last().force;
  }
  EXPECT_LT((coupling.take_mean_force() - impulse / (3.5 * dt)).norm(), 1e-12);
  EXPECT_EQ(coupling.take_mean_force(), Vec3::Zero());
}

TEST(Coupling, a_restored_one_goes_on_summing_the_mean_force) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest, fluid_density);
  fluid.fill_at_random(37);
  fem::Structure solid = plate({});
  Coupling coupling(solid, forest, coupled()), restored(solid, forest, coupled());
  for (int step = 0; step < 3; ++step) fluid.step(coupling, dt);
  copy_state(coupling, restored);
  const Vec3 mean = coupling.take_mean_force();
  EXPECT_NE(mean, Vec3::Zero());
  EXPECT_EQ(restored.take_mean_force(), mean);
}

TEST(Coupling, same_bits_for_any_number_of_threads) {
  const amr::Forest forest = cube_of_fine_blocks();
  const int threads_before = omp_get_max_threads();
  std::vector<Vec3> first;
  for (int threads : {1, 2, 4}) {
    omp_set_num_threads(threads);
    FakeFluid fluid(forest, fluid_density);
    fluid.fill_at_random(36);
    fem::Structure solid = plate({});
    Coupling coupling(solid, forest, coupled());
    for (int step = 0; step < 5; ++step) fluid.step(coupling, dt);
    const std::vector<Vec3> position(solid.position().begin(), solid.position().end());
    if (threads == 1) first = position;
    EXPECT_EQ(position, first) << threads << " threads";
  }
  omp_set_num_threads(threads_before);
}

TEST(Coupling, a_body_that_leaves_the_finest_blocks_is_named) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest, fluid_density);
  fem::Structure solid = plate({}, Vec3(0.99, 0, 0));
  Coupling coupling(solid, forest, coupled("canopy"));
  try {
    fluid.step(coupling, dt);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("body 'canopy': marker 0 at"), 0u) << error.what();
  }
}

}  // namespace
}  // namespace drogue::fsi
