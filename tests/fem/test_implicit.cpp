// SPDX-License-Identifier: GPL-3.0-or-later
// Generalised-alpha: order, damping, pairs, holds, and agreement with the explicit scheme.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../core/memory_archive.hpp"
#include "bodies.hpp"
#include "core/error.hpp"

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

// What the first step finds is a sudden start; from then on the energy of modes it resolves is that of the scheme.
TEST(Implicit, a_free_vibration_keeps_its_energy_as_far_as_the_spectral_radius_says) {
  const double period = 0.2 / bar_speed;
  struct Sample {
    double radius, kept;
  };
  for (const auto& [radius, kept] : {Sample{1.0, 0.999}, Sample{0.8, 0.995}, Sample{0.5, 0.97}}) {
    Structure bar = vibrating_bar(implicit(radius));
    const double start = energy(bar);
    double least = start, most = start;
    for (int step = 0; step < 50 * 10; ++step) {
      bar.advance(period / 50.0, 0.0);
      least = std::min(least, energy(bar));
      most = std::max(most, energy(bar));
    }
    std::printf("spectral radius %.1f: energy over ten periods from %.5f to %.5f\n", radius, least / start,
                most / start);
    EXPECT_GT(least, kept * start);
    EXPECT_LT(most, 1.001 * start);
  }
}

/// A plate on tethers and a moving hold, its pairs with other masses than their own, under gravity and damped.
Structure coupled_plate(const StructureOptions& options) {
  const Mesh mesh = make_plate({Vec3::Zero(), 0, {0.1, 0.08}, 5e-3, {5, 4, 1}});
  Model model = one_solid(mesh, neo_hookean, 1.0, {}, options);
  model.loads.holds = {
      {.nodes = nodes_named(mesh, "y_min"), .rigid = true, .displacement = {Expression("0.01*sin(100*t)"), {}, {}}},
      {.nodes = nodes_named(mesh, "y_max"), .stiffness = 1e6, .damping = 1e3}};
  model.loads.gravity = Vec3(0, 0, -20);
  model.loads.damping = 2.0;
  Structure plate(std::move(model));
  plate.set_inertia(paired(plate, 20.0));
  return plate;
}

TEST(Implicit, pairs_holds_and_loads_act_as_in_the_explicit_scheme) {
  StructureOptions leapfrog;
  leapfrog.dissipation = 0.0;
  leapfrog.safety = 0.02;
  Structure exact = coupled_plate(leapfrog), body = coupled_plate(implicit(0.8));
  constexpr double dt = 5e-4;
  double moved = 0.0, apart = 0.0;
  for (int step = 0; step < 40; ++step) {
    exact.advance(dt, step * dt);
    body.advance(dt, step * dt);
    EXPECT_EQ(body.substeps(), 1);
    moved = std::max(moved, distance(exact.position(), exact.mesh().nodes));
    apart = std::max(apart, distance(exact.position(), body.position()));
  }
  std::printf("moved by %.3g m, apart by %.3g m\n", moved, apart);
  EXPECT_LT(apart, 0.01 * moved);
  EXPECT_GT(moved, 5e-3);
}

TEST(Implicit, momentum_is_conserved_and_what_holds_take_of_it_is_their_reaction) {
  Structure bar = vibrating_bar(implicit(0.8));
  const auto momentum = [](const Structure& body) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < body.velocity().size(); ++i) sum += body.own_mass()[i] * body.velocity()[i];
    return sum;
  };
  std::vector<Vec3> v = copy(bar.velocity());
  for (Vec3& u : v) u += Vec3(1, 2, 3);
  bar.set_state(bar.position(), v);
  const Vec3 before = momentum(bar);
  for (int step = 0; step < 50; ++step) bar.advance(1e-4, 0.0);
  EXPECT_LT((momentum(bar) - before).norm(), 1e-8 * before.norm());

  // At rest under gravity the holds carry the weight.
  const Mesh mesh = block({0.1, 0.02, 0.02}, {4, 1, 1});
  Model model =
      one_solid(mesh, neo_hookean, 1.0, {{.nodes = nodes_named(mesh, "x_min"), .rigid = true}}, implicit(0.0));
  model.loads.gravity = Vec3(0, 0, -10);
  model.loads.damping = 50.0;
  Structure beam(std::move(model));
  for (int step = 0; step < 400; ++step) beam.advance(5e-3, 0.0);
  EXPECT_NEAR(beam.reaction().z() / (10.0 * 0.1 * 0.02 * 0.02), 1.0, 1e-6);
}

TEST(Implicit, a_restored_state_goes_on_with_the_same_bits) {
  Structure whole = coupled_plate(implicit(0.8)), continued = coupled_plate(implicit(0.8));
  const double dt = 5e-4;
  for (int step = 0; step < 3; ++step) whole.advance(dt, step * dt);
  testing::copy_state(whole, continued);
  for (Structure* plate : {&whole, &continued}) {
    for (int step = 3; step < 6; ++step) plate->advance(dt, step * dt);
  }
  EXPECT_EQ(copy(continued.position()), copy(whole.position()));
  EXPECT_EQ(copy(continued.velocity()), copy(whole.velocity()));
  EXPECT_EQ(continued.reaction(), whole.reaction());
}

TEST(Implicit, a_step_that_tears_an_element_is_divided_until_it_can_be_named) {
  // Thrown against its hold with more energy than it can bear.
  const Mesh mesh = block({0.1, 0.02, 0.02}, {4, 1, 1});
  Structure bar(
      one_solid(mesh, neo_hookean, 1.0, {{.nodes = nodes_named(mesh, "x_min"), .rigid = true}}, implicit(0.8)));
  bar.set_state(mesh.nodes, std::vector<Vec3>(mesh.nodes.size(), Vec3(-1000, 0, 0)));
  try {
    for (int step = 0; step < 10; ++step) bar.advance(1e-3, 0.0);
    FAIL() << "nothing was thrown";
  } catch (const Diverged& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("the structure is torn or inverted in hexahedron"), std::string::npos) << message;
  }
  EXPECT_GT(bar.substeps(), 1);
}

TEST(Implicit, auto_is_implicit_where_sub_steps_outnumber_what_a_factorisation_costs) {
  Mesh mesh;
  const int first = add_point(mesh, "first", Vec3::Zero()), last = add_point(mesh, "last", Vec3(1, 0, 0));
  add_line(mesh, "cable", first, last, 4);
  StructureOptions options;
  options.integrator = Integrator::cheaper;
  const Structure cable(Model{mesh, {{"", 100.0, Cable{{1e10, true}, 1e-6}}}, {}, options});
  EXPECT_EQ(cable.integrator_for(1e-2), Integrator::implicit_scheme);
  EXPECT_EQ(cable.integrator_for(1e-5), Integrator::explicit_scheme);
}

}  // namespace
}  // namespace drogue::fem
