// SPDX-License-Identifier: GPL-3.0-or-later
// Cables, point masses, dead loads, gravity, prescribed motion.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bodies.hpp"

namespace drogue::fem {
namespace {

/// A cable from the origin to `end`, of `elements`, held at its beginning, and at its end if `both`.
Model cable(const Vec3& end, int elements, double young, double length_ratio, bool both) {
  Mesh mesh;
  const int first = add_point(mesh, "start", Vec3::Zero()), last = add_point(mesh, "end", end);
  add_line(mesh, "cable", first, last, elements);
  Model model{mesh, {{"", 1000.0, Cable{{young, true}, 1e-6, length_ratio}}}, {}, {}};
  model.loads.holds = {{.nodes = {first}, .rigid = true}};
  if (both) model.loads.holds.push_back({.nodes = {last}, .rigid = true});
  return model;
}

double lowest(const Structure& body) {
  double z = 0.0;
  for (const Vec3& x : body.position()) z = std::min(z, x.z());
  return z;
}

TEST(Cables, a_hanging_cable_sags_like_a_catenary) {
  for (const auto& [length, sag] : {std::pair{1.10, 0.200301}, std::pair{1.20, 0.292344}, std::pair{2.0, 0.796388}}) {
    // The weight stretches it by 1e-4.
    Model model = cable(Vec3(1, 0, 0), 40, 1e8, length, true);
    model.loads.gravity = Vec3(0, 0, -9.81);
    Structure body(std::move(model));
    body.find_equilibrium(0.0, {.method = Equilibrium::relaxation, .tolerance = 1e-5});
    EXPECT_NEAR(-lowest(body) / sag, 1.0, 2e-3) << length;
    EXPECT_NEAR(body.reaction().z() / (1000.0 * 1e-6 * length * 9.81), 1.0, 1e-3);
  }
}

TEST(Cables, a_slack_cable_bears_no_compression) {
  Structure body((cable(Vec3(1, 0, 0), 1, 1e6, 1.2, true)));
  EXPECT_EQ(largest_norm(internal_force(body, body.mesh().nodes)), 0.0);
  Structure taut((cable(Vec3(1, 0, 0), 1, 1e6, 0.9, true)));
  const auto force = internal_force(taut, taut.mesh().nodes);
  EXPECT_NEAR(force[0].x(), 1e6 * 1e-6 * (1.0 / 0.9 - 1.0), 1e-12);
  EXPECT_NEAR((force[0] + force[1]).norm(), 0.0, 1e-15);
}

TEST(Cables, a_point_mass_swings_with_the_period_of_a_pendulum) {
  constexpr double length = 1.0, gravity = 9.81, angle = 0.1;
  Model model = cable(length * Vec3(std::sin(angle), 0, -std::cos(angle)), 1, 1e9, 1.0, false);
  model.loads.masses = {{1, 0.01}};
  model.loads.gravity = Vec3(0, 0, -gravity);
  Structure body(std::move(model));
  const double small = 2.0 * std::numbers::pi * std::sqrt(length / gravity);
  std::vector<double> crossings;
  double before = 1.0;
  const double dt = 1e-3;
  for (int step = 1; crossings.size() < 3; ++step) {
    body.advance(dt, (step - 1) * dt);
    const double now = body.position()[1].x();
    if (before > 0.0 && now <= 0.0) crossings.push_back((step - now / (now - before)) * dt);
    before = now;
  }
  // 1/16 of the squared amplitude; the weight stretches the cable by 1e-4.
  EXPECT_NEAR((crossings[2] - crossings[0]) / (2.0 * small), 1.0 + angle * angle / 16.0, 2e-4);
}

TEST(Cables, an_active_stress_shortens_a_free_cable_to_where_it_balances_the_passive_one) {
  Model model = cable(Vec3(1, 0, 0), 2, 1e6, 1.0, false);
  std::get<Cable>(model.regions[0].kind).material.tension_only = false;
  model.regions[0].active.tension = Expression("1e5*t");
  Structure body(std::move(model));
  body.find_equilibrium(1.0, {.method = Equilibrium::relaxation, .tolerance = 1e-9});
  // E (lambda - 1) + T lambda^2 = 0
  const double stretch = (-1.0 + std::sqrt(1.0 + 4.0 * 0.1)) / 0.2;
  EXPECT_NEAR(body.position()[1].x(), stretch, 1e-8);
}

TEST(Cables, a_dead_load_is_shared_and_answered_by_the_hold) {
  Model model = cable(Vec3(0, 0, -2), 4, 1e6, 1.0, false);
  model.loads.forces = {{{1}, {Expression(0.0), Expression(0.0), Expression("-0.1*t")}}};
  Structure body(std::move(model));
  body.find_equilibrium(2.0, {.method = Equilibrium::relaxation, .tolerance = 1e-9});
  EXPECT_NEAR(body.position()[1].z(), -2.0 * (1.0 + 0.2), 1e-8);
  EXPECT_NEAR(body.reaction().z(), 0.2, 1e-9);
}

TEST(Structure, a_sheet_with_cables_and_a_point_mass_keeps_its_momenta_and_energy) {
  Mesh mesh = make_sheet({{Vec3(0, 0, 0), Vec3(0.4, 0, 0), Vec3(0.4, 0.4, 0), Vec3(0, 0.4, 0)}, {4, 4}});
  const int load = add_point(mesh, "load", Vec3(0.2, 0.2, -0.5));
  for (const int corner :
       corner_nodes(make_sheet({{mesh.nodes[0], mesh.nodes[4], mesh.nodes[24], mesh.nodes[20]}, {4, 4}}), 0.0)) {
    add_line(mesh, "lines", corner, load, 3);
  }
  const OrthotropicFabric fabric(1e5, 1e5, 0.2, 4e4);
  Model model{mesh, {{"", 300.0, Membrane{fabric, 1e-3}}, {"lines", 800.0, Cable{{1e6, false}, 1e-5}}}, {}, {}};
  model.loads.masses = {{load, 0.05}};
  model.options.dissipation = 0.0;
  model.options.safety = 0.05;
  Structure body(std::move(model));
  auto v = random_vectors(mesh.nodes.size(), 0.2, 8);
  for (std::size_t i = 0; i < v.size(); ++i) v[i] += Vec3(1, 2, 3) + Vec3(2, -1, 4).cross(mesh.nodes[i]);
  body.set_state(mesh.nodes, v);
  struct Momenta {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  };
  const auto momenta = [&] {
    Momenta sum;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const Vec3 momentum = body.own_mass()[i] * body.velocity()[i];
      sum.linear += momentum;
      sum.angular += body.position()[i].cross(momentum);
    }
    return sum;
  };
  const Momenta before = momenta();
  const double energy = body.kinetic_energy();
  for (int step = 0; step < 100; ++step) {
    body.advance(1e-3, 0.0);
    EXPECT_NEAR(synchronised_energy(body, 1e-3 / body.substeps()) / energy, 1.0, 1e-3) << step;
  }
  EXPECT_LT((momenta().linear - before.linear).norm(), 1e-12 * before.linear.norm());
  EXPECT_LT((momenta().angular - before.angular).norm(), 1e-11 * before.angular.norm());
  EXPECT_GT(body.elastic_energy(), 1e-4 * energy);
}

TEST(Structure, held_nodes_follow_a_prescribed_motion_along_the_axes_that_are_held) {
  Model model = cable(Vec3(1, 0, 0), 1, 1e6, 1.0, false);
  model.loads.holds = {
      {.nodes = {0}, .rigid = true},
      {.nodes = {1}, .rigid = true, .axes = {true, false, false}, .displacement = {Expression("0.1*t")}}};
  model.loads.gravity = Vec3(0, 0, -1.0);
  Structure body(std::move(model));
  for (int step = 0; step < 10; ++step) body.advance(0.01, 0.01 * step);
  EXPECT_NEAR(body.position()[1].x(), 1.01, 1e-12);
  EXPECT_NEAR(body.velocity()[1].x(), 0.1, 1e-6);
  EXPECT_LT(body.position()[1].z(), -1e-3);
}

TEST(Structure, damping_takes_the_momentum_of_a_free_body_at_its_rate) {
  Model model = cable(Vec3(1, 0, 0), 3, 1e6, 1.0, false);
  model.loads.holds.clear();
  model.loads.damping = 2.0;
  Structure body(std::move(model));
  body.set_state(body.mesh().nodes, std::vector<Vec3>(body.mesh().nodes.size(), Vec3(1, 2, 3)));
  for (int step = 0; step < 1000; ++step) body.advance(5e-4, 5e-4 * step);
  EXPECT_NEAR(body.velocity()[0].y() / (2.0 * std::exp(-1.0)), 1.0, 1e-3);
}

}  // namespace
}  // namespace drogue::fem
