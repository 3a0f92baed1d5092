// SPDX-License-Identifier: GPL-3.0-or-later
// Long runs in a fluid that only decays: what grows here grows by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bodies.hpp"

namespace drogue::fsi {
namespace {

using namespace drogue::testing;

constexpr double spacing = 1.0 / 16, dt = 4e-3;
const Vec3 centre(1.02, 0.49, 0.51);

class Stability : public OnOneThread {};

fem::Structure held_plate(double density, fem::Integrator integrator = fem::Integrator::explicit_scheme) {
  PlateOptions options{.density = density, .thickness = 0.02, .elements = 8, .structure = {.integrator = integrator}};
  const fem::Structure free = plate(options, centre);
  options.holds = {{.nodes = fem::corner_nodes(free.mesh(), 0.5 / 8), .rigid = true}};
  return plate(options, centre);
}

/// With the density of the fluid, or none.
class LightPlate : public Stability, public ::testing::WithParamInterface<double> {};

INSTANTIATE_TEST_SUITE_P(Density, LightPlate, ::testing::Values(0.0, fluid_density),
                         [](const auto& test) { return test.param == 0.0 ? "none" : "that_of_the_fluid"; });

TEST_P(LightPlate, stays_bounded_for_thousands_of_steps) {
  const amr::Forest forest = periodic_box();
  FakeFluid fluid(forest, fluid_density);
  fem::Structure solid = held_plate(GetParam());
  Coupling coupling(solid, forest, coupled());
  double fastest = 0.0, fastest_closing = 0.0, thinnest = 1.0, thickest = 1.0;
  for (int step = 0; step < 2000; ++step) {
    // A gust that comes again and again, and blows the plate up by a good part of its side.
    if (step % 200 == 0) {
      fluid.fill(
          [&](const Vec3& x) { return Vec3(1.5, 0.1 * std::sin(20 * x.z()), 0.1 * std::cos(31 * x.y() + step)); });
    }
    fluid.step(coupling, dt, 0.99);
    fastest = std::max(fastest, largest_speed(solid));
    fastest_closing = std::max(fastest_closing, solid.face_velocity_difference()[0]);
    thinnest = std::min(thinnest, solid.volume_ratio_range()[0]);
    thickest = std::max(thickest, solid.volume_ratio_range()[1]);
    ASSERT_LT(fastest, 3.0) << step;
  }
  std::printf("largest: speed %.3g m/s, closing of faces %.3g m/s rms, J %.3f to %.3f, %d sub-steps\n", fastest,
              fastest_closing, thinnest, thickest, solid.substeps());
  EXPECT_LT(fastest_closing, 0.05 * fastest);
  EXPECT_GT(thinnest, 0.5);
  EXPECT_LT(thickest, 2.0);
}

TEST_P(LightPlate, moves_alike_by_the_implicit_scheme) {
  const amr::Forest forest = periodic_box();
  FakeFluid fluid(forest, fluid_density), other_fluid(forest, fluid_density);
  fem::Structure solid = held_plate(GetParam()), other = held_plate(GetParam(), fem::Integrator::implicit_scheme);
  Coupling coupling(solid, forest, coupled()), other_coupling(other, forest, coupled());
  const auto gust = [](const Vec3& x) { return Vec3(1.5, 0.1 * std::sin(20 * x.z()), 0.1 * std::cos(31 * x.y())); };
  fluid.fill(gust);
  other_fluid.fill(gust);
  double moved = 0.0, apart = 0.0;
  for (int step = 0; step < 100; ++step) {
    fluid.step(coupling, dt, 0.99);
    other_fluid.step(other_coupling, dt, 0.99);
    for (std::size_t point = 0; point < solid.inertia().point.size(); ++point) {
      const Vec3 position = solid.mean_position(static_cast<int>(point));
      apart = std::max(apart, (position - other.mean_position(static_cast<int>(point))).norm());
      moved = std::max(moved, (position.x() - centre.x()));
    }
  }
  std::printf("moved by %.3g m, apart by %.3g m, %d and %d sub-steps\n", moved, apart, solid.substeps(),
              other.substeps());
  EXPECT_LT(apart, 0.05 * moved);
}

TEST_P(LightPlate, loses_a_disturbance_of_its_thickness) {
  const amr::Forest forest = periodic_box();
  FakeFluid fluid(forest, fluid_density);
  fem::Structure solid = held_plate(GetParam());
  Coupling coupling(solid, forest, coupled());
  auto opposite = random_vectors(solid.position().size(), 0.3, 42);
  for (const auto& [a, b] : solid.inertia().point) opposite[b] = -opposite[a];
  add_velocity(solid, opposite);
  const double first = solid.face_velocity_difference()[1];
  // Faces that move against each other along the plate bend it, and bending swings back.
  for (const double bound : {0.3, 0.1, 0.05}) {
    for (int step = 0; step < 33; ++step) fluid.step(coupling, dt);
    EXPECT_LT(solid.face_velocity_difference()[1], bound * first);
  }
  EXPECT_NEAR(solid.mean_thickness_stretch(), 1.0, 0.02);
}

/// What a step of the coupling does to one mode of a structure: position x, velocity v and that of the fluid U, which
/// the delta function sees with the gain g. The unit of time is a sub-step, of which `phase` = omega h.
Mat3 step_of_a_mode(double reset, double gain, double phase, double substeps, double phi) {
  Mat3 common = Mat3::Identity(), substep = Mat3::Identity(), give = Mat3::Identity();
  common.row(1) << 0.0, reset, 1.0 - reset;
  substep.row(0) << 1.0 - phi * phase * phase, 1.0, 0.0;
  substep.row(1) << -phase * phase, 1.0, 0.0;
  give.row(2) << 0.0, gain, 1.0 - gain;
  Mat3 step = common;
  for (int n = 0; n < substeps; ++n) step = substep * step;
  return give * step;
}

/// By squaring again and again.
double spectral_radius(Mat3 matrix) {
  double logarithm = 0.0, weight = 1.0;
  for (int k = 0; k < 40; ++k, weight *= 0.5) {
    const double norm = matrix.norm();
    logarithm += weight * std::log(norm);
    matrix = (matrix / norm) * (matrix / norm);
  }
  return std::exp(logarithm);
}

TEST_F(Stability, no_mode_grows_with_the_sub_steps_that_are_taken) {
  for (const double dissipation : {0.02, 0.2, 0.45}) {
    const double phi = 1.0 + dissipation, limit = 0.9 * 2.0 / std::sqrt(2.0 * phi - 1.0);
    fem::Structure solid = plate({.elements = 2, .structure = {.dissipation = dissipation}});
    fem::Inertia inertia = solid.inertia();
    for (const double reset : {-0.98, -0.8, -0.5, -0.2, 0.0, 0.3, 0.7, 0.99}) {
      inertia.reset = reset;
      solid.set_inertia(inertia);
      double fastest = 0.0, fastest_before = 0.0;  // growth in a step
      for (const double stable_steps : {0.1, 0.9, 1.5, 2.7, 7.7, 20.0}) {
        const double before = std::ceil(stable_steps),
                     taken = solid.explicit_substeps(stable_steps * solid.stable_step());
        for (int i = 1; i <= 50; ++i) {
          for (const double gain : {0.0, 1e-3, 0.03, 0.3, 1.0}) {
            const auto growth = [&](double substeps) {
              const double phase = limit * stable_steps / substeps * i / 50;
              return spectral_radius(step_of_a_mode(reset, gain, phase, substeps, phi)) - 1.0;
            };
            fastest = std::max(fastest, growth(taken));
            fastest_before = std::max(fastest_before, growth(before));
          }
        }
      }
      std::printf("dissipation %.2f, reset %5.2f: growth %.2g, without more sub-steps %.2g\n", dissipation, reset,
                  fastest, fastest_before);
      EXPECT_LT(fastest, 1e-9);
      if (reset < 0.0) {
        EXPECT_GT(fastest_before, 1e-3);
      }
    }
  }
}

class ThickSolid : public Stability, public ::testing::WithParamInterface<double> {};

TEST_P(ThickSolid, slip_decays_for_any_density_that_is_accepted) {
  const amr::Forest forest = periodic_box();
  FakeFluid fluid(forest, fluid_density);
  fluid.fill_at_random(43);
  fem::Structure solid(fem::one_solid(fem::make_plate({centre, 0, {0.375, 0.375}, 0.375, {6, 6, 6}}),
                                      fem::NeoHookean(1000.0, 0.3, 0.3), GetParam() * fluid_density));
  Coupling coupling(solid, forest, coupled("cube"));
  double first = 0.0;
  for (int step = 0; step < 1500; ++step) {
    fluid.step(coupling, dt);
    if (step == 0) first = coupling.last().slip_before;
    ASSERT_LT(fluid.max_speed(), 4.0) << step;
  }
  std::printf("slip %.2g of that at first, %d sub-steps where the stable step asks for %.0f\n",
              coupling.last().slip_before / first, solid.substeps(), std::ceil(dt / solid.stable_step()));
  EXPECT_LT(coupling.last().slip_before, 0.2 * first);
}

INSTANTIATE_TEST_SUITE_P(DensityRatio, ThickSolid, ::testing::Values(0.55, 1.0, 3.0, 1000.0), [](const auto& test) {
  return "percent_" + std::to_string(static_cast<int>(100 * test.param));
});

}  // namespace
}  // namespace drogue::fsi
