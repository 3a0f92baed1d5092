// SPDX-License-Identifier: GPL-3.0-or-later
// Motion of a structure: conservation, damping, pairs, holds, threads.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "../core/memory_archive.hpp"
#include "bodies.hpp"
#include "core/error.hpp"

namespace drogue::fem {
namespace {

const NeoHookean neo_hookean(1e3, 0.3, 0.3);
const SaintVenantKirchhoff saint_venant_kirchhoff(1e3, 0.3);
/// Speed of waves along a bar, sqrt(E / rho), at a density of 1 kg/m^3.
const double bar_speed = std::sqrt(1e3);
/// Speed of waves across a plate, sqrt((lambda + 2 mu) / rho).
const double thickness_speed = std::sqrt(1346.15);

Mesh thin_plate() { return make_plate({Vec3::Zero(), 0, {0.1, 0.08}, 5e-3, {7, 5, 1}}); }

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

/// With the masses of the points: M of the means, the reduced mass of the faces of the differences.
Momenta momenta(const Structure& body) {
  Momenta sum;
  for (std::size_t i = 0; i < body.inertia().point.size(); ++i) {
    const auto [a, b] = body.inertia().point[i];
    const Vec3 momentum = body.inertia().mass[i] * body.mean_velocity(static_cast<int>(i));
    sum.linear += momentum;
    sum.angular += body.mean_position(static_cast<int>(i)).cross(momentum);
    if (b < 0) continue;
    const double ma = body.inertia().face_mass[a], mb = body.inertia().face_mass[b];
    const Vec3 distance = body.position()[a] - body.position()[b], closing = body.velocity()[a] - body.velocity()[b];
    sum.angular += ma * mb / (ma + mb) * distance.cross(closing);
  }
  return sum;
}

TEST(Structure, free_vibration_keeps_its_energy_over_a_hundred_periods) {
  constexpr double length = 0.1;
  for (const Material& law : {Material(neo_hookean), Material(saint_venant_kirchhoff)}) {
    const Mesh mesh = block({length, 0.01, 0.01}, {10, 1, 1});
    Structure bar = solid(mesh, law, {.density = 1.0, .dissipation = 0.0}, {});
    // The lowest axial mode at 3 % strain: sin(pi x / L) about the middle.
    std::vector<Vec3> v(mesh.nodes.size(), Vec3::Zero());
    const double speed = 0.03 * bar_speed;
    for (std::size_t i = 0; i < v.size(); ++i)
      v[i].x() = speed * std::sin(std::numbers::pi * mesh.nodes[i].x() / length);
    bar.set_state(mesh.nodes, v);
    const double period = 2.0 * length / bar_speed, dt = period / 2.0;
    const double start = bar.kinetic_energy();
    double largest = 0.0;
    for (int half_period = 0; half_period < 200; ++half_period) {
      bar.advance(dt, 0.0);
      const double change = synchronised_energy(bar, dt / bar.substeps()) / start - 1.0;
      EXPECT_LT(std::abs(change), 1e-3) << half_period;
      largest = std::max(largest, std::abs(change));
    }
    std::printf("largest change of the energy: %.2g\n", largest);
  }
}

TEST(Structure, lowest_frequency_of_a_bar_is_that_of_the_wave_equation) {
  constexpr double length = 0.2;
  const Mesh mesh = block({length, 0.01, 0.01}, {20, 1, 1});
  const int tip = 20;
  Structure bar = solid(mesh, neo_hookean, {.density = 1.0, .dissipation = 0.0}, {});
  std::vector<Vec3> v(mesh.nodes.size(), Vec3::Zero());
  for (std::size_t i = 0; i < v.size(); ++i) v[i].x() = 1e-3 * std::sin(std::numbers::pi * mesh.nodes[i].x() / length);
  bar.set_state(mesh.nodes, v);
  const double period = 2.0 * length / bar_speed, dt = period / 200.0;
  const double rest = mesh.nodes[tip].x();
  std::vector<double> crossings;
  double before = 0.0;
  for (int step = 1; crossings.size() < 10; ++step) {
    bar.advance(dt, 0.0);
    const double now = bar.position()[tip].x() - rest;
    if (before * now < 0.0) crossings.push_back((step - now / (now - before)) * dt);
    before = now;
  }
  // Lateral inertia (Love) and 20 elements change it by 1e-3 each at most.
  EXPECT_NEAR((crossings[9] - crossings[1]) / (4.0 * period), 1.0, 3e-3);
}

TEST(Structure, momentum_and_angular_momentum_are_conserved_without_holds) {
  for (const double factor : {1.0, 0.5, 30.0}) {
    Structure plate = solid(thin_plate(), neo_hookean, {.density = 1.0, .dissipation = 0.0}, {});
    Inertia inertia = paired(plate, factor);
    for (const auto& [a, b] : inertia.point) inertia.face_mass[a] *= 3.0;  // not their own, nor alike
    plate.set_inertia(std::move(inertia));
    const auto x = sum(plate.mesh().nodes, random_vectors(plate.mesh().nodes.size(), 3e-4, 1));
    auto v = random_vectors(x.size(), 1.0, 2);
    for (std::size_t i = 0; i < v.size(); ++i) v[i] += Vec3(1.0, 2.0, 3.0) + Vec3(30.0, -10.0, 20.0).cross(x[i]);
    plate.set_state(x, v);
    const Momenta before = momenta(plate);
    for (int step = 0; step < 20; ++step) plate.advance(1e-3, 0.0);
    const Momenta after = momenta(plate);
    EXPECT_GT(plate.substeps(), 5);
    EXPECT_LT((after.linear - before.linear).norm(), 1e-12 * before.linear.norm()) << factor;
    EXPECT_LT((after.angular - before.angular).norm(), 1e-11 * before.angular.norm()) << factor;
  }
}

TEST(Structure, dissipation_removes_the_thickness_mode_within_a_few_sub_steps) {
  Structure plate = solid(thin_plate(), neo_hookean, {.density = 1.0}, {});
  plate.set_inertia(paired(plate, 40.0));
  std::vector<Vec3> v(plate.mesh().nodes.size(), Vec3::Zero());
  for (std::size_t i = 0; i < v.size(); ++i) v[i].x() = std::copysign(0.05, plate.mesh().nodes[i].x());
  plate.set_state(plate.mesh().nodes, v);
  const double start = energy(plate), difference = plate.face_velocity_difference()[0];
  EXPECT_NEAR(difference, 0.1, 1e-12);
  EXPECT_NEAR(plate.face_velocity_difference()[1], 0.1, 1e-12);
  // Squared modulus 1 - 0.2 (omega dt)^2 = 0.6 a sub-step: a tenth after five, a hundredth after nine.
  plate.advance(9.0 * 1.5 / plate.largest_frequency(), 0.0);
  EXPECT_LE(plate.substeps(), 10);
  EXPECT_LT(energy(plate), 0.1 * start);
  EXPECT_LT(plate.face_velocity_difference()[0], 0.3 * difference);
}

TEST(Structure, dissipation_spares_what_the_sub_step_resolves) {
  // Axial mode of a strip whose pairs carry 40 times its mass, against a sub-step set by the thickness.
  constexpr double length = 0.2;
  const Mesh mesh = block({length, 0.02, 1e-3}, {10, 1, 1});
  Structure strip = solid(mesh, neo_hookean, {.density = 1.0}, {});
  strip.set_inertia(paired(strip, 40.0));
  std::vector<Vec3> v(mesh.nodes.size(), Vec3::Zero());
  for (std::size_t i = 0; i < v.size(); ++i) v[i].x() = 0.02 * std::sin(std::numbers::pi * mesh.nodes[i].x() / length);
  strip.set_state(mesh.nodes, v);
  const double start = strip.kinetic_energy(), period = 2.0 * length / bar_speed * std::sqrt(40.0);
  for (int step = 0; step < 30; ++step) strip.advance(period / 10.0, 0.0);
  EXPECT_GT(energy(strip), 0.99 * start);
  EXPECT_LT(energy(strip), 1.001 * start);
}

TEST(Structure, pairs_with_their_own_mass_move_as_free_nodes) {
  Structure nodes = solid(thin_plate(), neo_hookean, {.density = 1.0}, {});
  Structure pairs = solid(thin_plate(), neo_hookean, {.density = 1.0}, {});
  pairs.set_inertia(paired(pairs, 1.0));
  const auto v = random_vectors(nodes.mesh().nodes.size(), 1.0, 4);
  nodes.set_state(nodes.mesh().nodes, v);
  pairs.set_state(nodes.mesh().nodes, v);
  EXPECT_NEAR(nodes.kinetic_energy(), pairs.kinetic_energy(), 1e-14 * nodes.kinetic_energy());
  nodes.advance(1e-3, 0.0);
  pairs.advance(1e-3, 0.0);
  for (std::size_t i = 0; i < v.size(); ++i) EXPECT_LT((nodes.position()[i] - pairs.position()[i]).norm(), 1e-13);
}

TEST(Structure, a_hinged_plate_swings_freely) {
  const Mesh mesh = thin_plate();
  Hold hinge{.nodes = {}, .rigid = true, .hinged = true};
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (mesh.nodes[i].y() < -0.05 + 1e-9) hinge.nodes.push_back(static_cast<int>(i));
  }
  Structure plate = solid(mesh, neo_hookean, {.density = 1.0, .dissipation = 0.0}, {hinge});
  plate.set_inertia(paired(plate, 1.0));
  constexpr double rate = 5.0, time = 0.1;
  const Vec3 axis_at(0.0, -0.05, 0.0);
  std::vector<Vec3> v;
  for (const Vec3& X : mesh.nodes) v.push_back(Vec3(0.0, 0.0, rate).cross(X - axis_at));
  plate.set_state(mesh.nodes, v);
  for (int step = 0; step < 20; ++step) plate.advance(time / 20, 0.0);
  const Mat3 turn = rotation(rate * time, Vec3::UnitZ());
  // It stretches by the centrifugal force, rho (omega L)^2 / (3 E) = 1e-4 of its length, and swings a little.
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    EXPECT_LT((plate.position()[i] - axis_at - turn * (mesh.nodes[i] - axis_at)).norm(), 3e-4) << i;
  }
}

TEST(Structure, mean_of_a_pair_accelerates_by_force_over_its_mass) {
  Structure plate = solid(thin_plate(), neo_hookean, {.density = 1.0, .dissipation = 0.0}, {});
  const Inertia inertia = paired(plate, 7.0);
  plate.set_inertia(inertia);
  const auto x = sum(plate.mesh().nodes, random_vectors(plate.mesh().nodes.size(), 3e-4, 1));
  const std::vector<Vec3> rest(x.size(), Vec3::Zero());
  plate.set_state(x, rest);
  const auto force = internal_force(plate, x);
  constexpr double dt = 1e-6;
  plate.advance(dt, 0.0);
  ASSERT_EQ(plate.substeps(), 1);
  for (std::size_t i = 0; i < inertia.point.size(); ++i) {
    const auto [a, b] = inertia.point[i];
    const Vec3 expected = dt * (force[a] + force[b]) / inertia.mass[i];
    EXPECT_LT((plate.mean_velocity(static_cast<int>(i)) - expected).norm(), 1e-12 * expected.norm());
    const Vec3 difference = dt * (force[a] / inertia.face_mass[a] - force[b] / inertia.face_mass[b]);
    EXPECT_LT((plate.velocity()[a] - plate.velocity()[b] - difference).norm(), 1e-12 * difference.norm());
  }
}

TEST(Structure, set_mean_velocity_keeps_the_difference_of_the_faces) {
  Structure plate = solid(thin_plate(), neo_hookean, {.density = 1.0}, {});
  plate.set_inertia(paired(plate, 3.0));
  plate.set_state(plate.mesh().nodes, random_vectors(plate.mesh().nodes.size(), 1.0, 9));
  const auto [a, b] = plate.inertia().point[5];
  const Vec3 difference = plate.velocity()[a] - plate.velocity()[b], v(1.0, -2.0, 3.0);
  plate.set_mean_velocity(5, v);
  EXPECT_LT((plate.mean_velocity(5) - v).norm(), 1e-15);
  EXPECT_LT((plate.velocity()[a] - plate.velocity()[b] - difference).norm(), 1e-15);
}

TEST(Structure, thickness_stretch_is_that_of_the_pairs) {
  Structure plate = solid(thin_plate(), neo_hookean, {.density = 1.0}, {});
  const auto thinner = mapped(plate.mesh().nodes, Vec3(0.7, 1.3, 1.3).asDiagonal());
  plate.set_state(thinner, std::vector<Vec3>(thinner.size(), Vec3::Zero()));
  EXPECT_EQ(plate.mean_thickness_stretch(), 1.0);
  EXPECT_EQ(plate.face_velocity_difference()[1], 0.0);
  plate.set_inertia(paired(plate, 3.0));
  EXPECT_NEAR(plate.mean_thickness_stretch(), 0.7, 1e-13);
}

std::vector<int> all_nodes(const Mesh& mesh) {
  std::vector<int> nodes(mesh.nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = static_cast<int>(i);
  return nodes;
}

// A load is what a coupling applies: an impulse to the means before every step.
void push(Structure& body, const Vec3& acceleration, double dt) {
  for (std::size_t i = 0; i < body.inertia().point.size(); ++i) {
    body.set_mean_velocity(static_cast<int>(i), body.mean_velocity(static_cast<int>(i)) + dt * acceleration);
  }
}

TEST(Structure, tethers_carry_a_load_with_displacement_load_over_stiffness) {
  const Mesh mesh = thin_plate();
  const Vec3 acceleration(3.0, -1.0, 2.0);
  for (const double factor : {0.5, 1.0, 20.0}) {
    // Critically damped; an impulse per sub-step shifts the balance by dissipation x damping x dt, so there is none.
    const double stiffness = 1e6, damping = 2.0 * std::sqrt(stiffness * factor), dt = 5e-5;
    Structure plate =
        solid(mesh, neo_hookean, {.density = 1.0, .dissipation = 0.0}, {{all_nodes(mesh), false, stiffness, damping}});
    plate.set_inertia(paired(plate, factor));
    for (int step = 0; step < 2000; ++step) {
      push(plate, acceleration, dt);
      plate.advance(dt, 0.0);
    }
    const double mass = factor * 0.1 * 0.08 * 5e-3, volume = 0.1 * 0.08 * 5e-3;
    const Vec3 load = mass * acceleration, displacement = load / (stiffness * volume);
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      EXPECT_LT((plate.position()[i] - mesh.nodes[i] - displacement).norm(), 1e-6 * displacement.norm()) << factor;
    }
    EXPECT_LT((plate.reaction() + load).norm(), 1e-6 * load.norm()) << factor;
  }
}

TEST(Structure, stiff_tethers_stay_stable_and_do_not_shorten_the_sub_step) {
  const Mesh mesh = thin_plate();
  const auto corners = corner_nodes(mesh, 0.016);
  Structure free_plate = solid(mesh, neo_hookean, {.density = 1.0}, {});
  Structure held = solid(mesh, neo_hookean, {.density = 1.0}, {{corners, false, 1e12, 0.0}});
  for (Structure* plate : {&free_plate, &held}) {
    plate->set_inertia(paired(*plate, 40.0));
    plate->set_state(mesh.nodes, random_vectors(mesh.nodes.size(), 0.5, 3));
    plate->advance(1e-3, 0.0);
  }
  EXPECT_EQ(held.substeps(), free_plate.substeps());
  for (int step = 0; step < 200; ++step) held.advance(1e-3, 0.0);
  for (const int node : corners) EXPECT_LT((held.position()[node] - mesh.nodes[node]).norm(), 1e-6);
}

TEST(Structure, rigid_hold_is_the_limit_of_stiff_tethers_and_its_reaction_is_the_lost_momentum) {
  const Mesh mesh = thin_plate();
  const auto corners = corner_nodes(mesh, 0.016);
  Structure rigid = solid(mesh, neo_hookean, {.density = 1.0}, {{corners, true}});
  Structure tethered = solid(mesh, neo_hookean, {.density = 1.0}, {{corners, false, 1e13, 0.0}});
  const Vec3 acceleration(0.5, 0.0, 0.1);
  constexpr double dt = 1e-3;
  for (Structure* plate : {&rigid, &tethered}) {
    plate->set_inertia(paired(*plate, 40.0));
    for (int step = 0; step < 30; ++step) {
      const Vec3 before = momenta(*plate).linear, load = 40.0 * 0.1 * 0.08 * 5e-3 * acceleration;
      push(*plate, acceleration, dt);
      plate->advance(dt, 0.0);
      EXPECT_LT((momenta(*plate).linear - before - dt * (load + plate->reaction())).norm(), 1e-14);
    }
  }
  for (const int node : corners) {
    EXPECT_EQ(rigid.position()[node], mesh.nodes[node]);
    EXPECT_EQ(rigid.velocity()[node], Vec3::Zero());
  }
  const double moved = (rigid.mean_position(20) - tethered.mean_position(20)).norm();
  EXPECT_GT(rigid.mean_position(20).x(), 1e-5);
  EXPECT_LT(moved, 1e-3 * rigid.mean_position(20).x());
}

TEST(Structure, every_number_of_threads_gives_the_same_bits) {
  const int threads_before = omp_get_max_threads();
  const Mesh mesh = make_plate({Vec3::Zero(), 0, {0.4, 0.4}, 5e-3, {35, 32, 1}});
  const auto v = random_vectors(mesh.nodes.size(), 0.5, 8);
  std::vector<Vec3> reference_position;
  Vec3 reference_reaction;
  for (const int threads : {1, 2, 4}) {
    omp_set_num_threads(threads);
    Structure plate = solid(mesh, neo_hookean, {.density = 1.0}, {{corner_nodes(mesh, 0.02), false, 1e7, 10.0}});
    plate.set_inertia(paired(plate, 40.0));
    plate.set_state(mesh.nodes, v);
    for (int step = 0; step < 5; ++step) plate.advance(7e-4, 0.0);
    const auto position = copy(plate.position());
    if (threads == 1) {
      reference_position = position;
      reference_reaction = plate.reaction();
    }
    EXPECT_EQ(std::memcmp(position.data(), reference_position.data(), position.size() * sizeof(Vec3)), 0) << threads;
    EXPECT_EQ(plate.reaction(), reference_reaction);
  }
  omp_set_num_threads(threads_before);
}

TEST(Structure, a_restored_state_goes_on_with_the_same_bits) {
  const Mesh mesh = thin_plate();
  const auto make = [&] {
    Structure plate = solid(mesh, neo_hookean, {.density = 1.0}, {{corner_nodes(mesh, 0.02), false, 1e7, 10.0}});
    plate.set_inertia(paired(plate, 40.0));
    return plate;
  };
  Structure whole = make(), continued = make();
  whole.set_state(mesh.nodes, random_vectors(mesh.nodes.size(), 0.5, 9));
  for (int step = 0; step < 3; ++step) whole.advance(7e-4, 0.0);
  testing::copy_state(whole, continued);
  for (Structure* plate : {&whole, &continued}) {
    for (int step = 0; step < 3; ++step) plate->advance(7e-4, 0.0);
  }
  EXPECT_EQ(copy(continued.position()), copy(whole.position()));
  EXPECT_EQ(copy(continued.velocity()), copy(whole.velocity()));
  EXPECT_EQ(continued.reaction(), whole.reaction());
  EXPECT_EQ(continued.substeps(), whole.substeps());
}

TEST(Structure, the_state_of_another_mesh_is_refused) {
  Mesh mesh = thin_plate();
  Structure plate = solid(mesh, neo_hookean, {.density = 1.0}, {});
  mesh.nodes.front().x() += 1e-4;
  Structure other = solid(mesh, neo_hookean, {.density = 1.0}, {});
  EXPECT_THROW(testing::copy_state(plate, other), InputError);
}

TEST(Structure, sub_steps_follow_the_thickness_mode) {
  Structure plate =
      solid(make_plate({Vec3::Zero(), 0, {0.8128, 0.8128}, 5e-3, {52, 52, 1}}), neo_hookean, {.density = 1.0}, {});
  plate.set_inertia(paired(plate, 40.0));
  plate.advance(7.8e-4, 0.0);
  // 2 c / h = 14.7e3 rad/s against 0.9 x 2 / sqrt(1.4) = 1.52.
  const double fewest = 7.8e-4 * 2.0 * thickness_speed / 5e-3 / 1.52;
  EXPECT_GE(plate.substeps(), fewest);
  EXPECT_LE(plate.substeps(), 1.1 * fewest + 1.0);
}

}  // namespace
}  // namespace drogue::fem
