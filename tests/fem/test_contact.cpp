// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of surfaces with each other and with themselves, of one body or of several.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <numbers>

#include "../core/memory_archive.hpp"
#include "bodies.hpp"
#include "core/error.hpp"
#include "crossings.hpp"
#include "fem/touching_structures.hpp"

namespace drogue::fem {
namespace {

const OrthotropicFabric fabric(1e6, 1e6, 0.2, 4e5);
constexpr double thickness = 1e-3, density = 500.0, gap = 0.01;

Mesh square(const Vec3& centre, double side, int elements, bool triangles) {
  const double h = 0.5 * side;
  const auto at = [&](double x, double y) -> Vec3 { return centre + Vec3(x, y, 0.0); };
  return make_sheet({{at(-h, -h), at(h, -h), at(h, h), at(-h, h)}, {elements, elements}, triangles});
}

Mesh joined(Mesh first, const Mesh& second) {
  const int shift = static_cast<int>(first.nodes.size());
  first.nodes.insert(first.nodes.end(), second.nodes.begin(), second.nodes.end());
  const auto append = [shift](auto& to, const auto& from) {
    for (auto cell : from) {
      for (int& node : cell) node += shift;
      to.push_back(cell);
    }
  };
  append(first.hexahedra, second.hexahedra);
  append(first.quadrilaterals, second.quadrilaterals);
  append(first.triangles, second.triangles);
  return first;
}

struct SheetOptions {
  double dissipation = 0.0;
  std::vector<Hold> holds{};
  Vec3 gravity = Vec3::Zero();
};

Structure sheet(Mesh mesh, const SheetOptions& options, const OrthotropicFabric& material = fabric) {
  Model model{
      std::move(mesh), {{"", density, Membrane{material, thickness}}}, {}, {.dissipation = options.dissipation}};
  model.loads.holds = options.holds;
  model.loads.gravity = options.gravity;
  return Structure(std::move(model));
}

/// Bodies that see each other, if there is contact.
struct Scene {
  std::vector<Structure> bodies;
  std::optional<TouchingStructures> touching{};

  void advance(double dt) {
    if (touching) {
      touching->advance(dt, 0.0);
      return;
    }
    for (Structure& body : bodies) body.advance(dt, 0.0);
  }
  template <class Action>
  void for_each_node(const Action& action) const {
    for (const Structure& body : bodies) {
      for (std::size_t i = 0; i < body.position().size(); ++i) action(body, i);
    }
  }
};

using MaybeContact = std::optional<ContactOptions>;

Scene scene(std::vector<Structure> bodies, const MaybeContact& contact) {
  Scene all{std::move(bodies)};
  if (!contact) return all;
  std::vector<Structure*> touching;
  for (Structure& body : all.bodies) touching.push_back(&body);
  all.touching.emplace(touching, *contact);
  return all;
}

Scene scene(Structure body, const MaybeContact& contact) {
  std::vector<Structure> bodies;
  bodies.push_back(std::move(body));
  return scene(std::move(bodies), contact);
}

/// Two parallel squares, one of quadrilaterals and one of triangles, that close in at 2 m/s: of one body, or of two of
/// which the upper one is three times as stiff.
Scene closing_squares(bool two_bodies, const MaybeContact& contact = ContactOptions{.gap = gap}) {
  Mesh lower = square(Vec3::Zero(), 0.2, 10, false), upper = square(Vec3(0.003, -0.002, 0.03), 0.2, 9, true);
  std::vector<Structure> bodies;
  if (two_bodies) {
    bodies.push_back(sheet(std::move(lower), {}));
    bodies.push_back(sheet(std::move(upper), {}, OrthotropicFabric(3e6, 3e6, 0.2, 1.2e6)));
  } else {
    bodies.push_back(sheet(joined(std::move(lower), upper), {}));
  }
  for (Structure& body : bodies) {
    std::vector<Vec3> v;
    for (const Vec3& x : body.position()) v.emplace_back(0.0, 0.0, x.z() > 0.01 ? -1.0 : 1.0);
    body.set_state(copy(body.position()), v);
  }
  return scene(std::move(bodies), contact);
}

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

Momenta momenta(const Scene& scene) {
  Momenta sum;
  scene.for_each_node([&](const Structure& body, std::size_t i) {
    const Vec3 momentum = body.own_mass()[i] * body.velocity()[i];
    sum.linear += momentum;
    sum.angular += body.position()[i].cross(momentum);
  });
  return sum;
}

double energy_of(const Scene& scene) {
  double sum = 0.0;
  for (const Structure& body : scene.bodies) sum += energy(body);
  return sum;
}

double synchronised_energy_after(const Scene& scene, double dt) {
  double sum = 0.0;
  for (const Structure& body : scene.bodies) sum += synchronised_energy(body, dt / body.substeps());
  return sum;
}

/// Lowest node of what was above 0.01 m at the start less the highest of what was below.
double clearance(const Scene& scene) {
  double lowest = INFINITY, highest = -INFINITY;
  scene.for_each_node([&](const Structure& body, std::size_t i) {
    const double z = body.position()[i].z();
    if (body.mesh().nodes[i].z() > 0.01) {
      lowest = std::min(lowest, z);
    } else {
      highest = std::max(highest, z);
    }
  });
  return lowest - highest;
}

class ClosingSquares : public ::testing::TestWithParam<bool> {};

INSTANTIATE_TEST_SUITE_P(Of, ClosingSquares, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "two_bodies" : "one_body"; });

TEST_P(ClosingSquares, part_again_with_their_momenta_and_energy) {
  Scene squares = closing_squares(GetParam());
  const Momenta before = momenta(squares);
  const double start = energy_of(squares);
  double nearest = INFINITY;
  for (int step = 0; step < 30; ++step) {
    squares.advance(1e-3);
    nearest = std::min(nearest, clearance(squares));
  }
  EXPECT_LT(nearest, gap);
  EXPECT_GT(clearance(squares), gap);
  const Momenta after = momenta(squares);
  const double scale = density * thickness * 0.04;  // of one square at 1 m/s
  EXPECT_LT((after.linear - before.linear).norm(), 1e-12 * scale);
  EXPECT_LT((after.angular - before.angular).norm(), 1e-13 * scale);
  EXPECT_NEAR(synchronised_energy_after(squares, 1e-3) / start, 1.0, 0.02);
}

TEST_P(ClosingSquares, pass_through_each_other_without_contact) {
  Scene squares = closing_squares(GetParam(), std::nullopt);
  for (int step = 0; step < 30; ++step) squares.advance(1e-3);
  EXPECT_LT(clearance(squares), 0.0);
}

TEST_P(ClosingSquares, lose_energy_and_no_momentum_with_damping) {
  Scene squares = closing_squares(GetParam(), ContactOptions{.gap = gap, .damping = 0.5});
  const double start = energy_of(squares);
  const Momenta before = momenta(squares);
  for (int step = 0; step < 30; ++step) squares.advance(1e-3);
  EXPECT_GT(clearance(squares), 0.0);
  EXPECT_LT(energy_of(squares), 0.8 * start);
  EXPECT_LT((momenta(squares).linear - before.linear).norm(), 1e-13);
  EXPECT_LT((momenta(squares).angular - before.angular).norm(), 1e-13);
}

TEST_P(ClosingSquares, hardly_need_shorter_sub_steps_while_they_touch) {
  Scene squares = closing_squares(GetParam());
  const double apart = squares.touching->stable_step();
  double shortest = apart;
  for (int step = 0; step < 30; ++step) {
    squares.advance(1e-3);
    shortest = std::min(shortest, squares.touching->stable_step());
  }
  EXPECT_LT(shortest, apart);
  EXPECT_GT(shortest, 0.9 * apart);
}

TEST(Contact, bodies_that_may_touch_share_the_sub_step_of_the_stiffest) {
  Scene alone = closing_squares(true, std::nullopt), together = closing_squares(true);
  alone.advance(1e-3);
  together.advance(1e-3);
  EXPECT_LT(alone.bodies[0].substeps(), alone.bodies[1].substeps());
  EXPECT_EQ(together.bodies[0].substeps(), alone.bodies[1].substeps());
  EXPECT_EQ(together.bodies[1].substeps(), alone.bodies[1].substeps());
}

/// A strip, of which one half lies held and the other is thrown over onto it.
Scene closing_book(const MaybeContact& contact, bool triangles) {
  Mesh mesh = make_sheet(
      {{Vec3(-0.3, -0.05, 0), Vec3(0.3, -0.05, 0), Vec3(0.3, 0.05, 0), Vec3(-0.3, 0.05, 0)}, {31, 5}, triangles});
  Hold lying;
  lying.rigid = true;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (mesh.nodes[i].x() < 0.0) lying.nodes.push_back(static_cast<int>(i));
  }
  Structure body = sheet(std::move(mesh), {.dissipation = 0.2, .holds = {lying}, .gravity = Vec3(0, 0, -9.81)});
  std::vector<Vec3> v(body.position().size(), Vec3::Zero());
  for (std::size_t i = 0; i < v.size(); ++i) v[i].z() = 20.0 * std::max(0.0, body.position()[i].x());
  body.set_state(copy(body.position()), v);
  return scene(std::move(body), contact);
}

/// How far below the lying half the other one ever reaches, away from the fold.
double depth(Scene book) {
  double lowest = 0.0;
  for (int step = 0; step < 250; ++step) {
    book.advance(2e-3);
    for (const Vec3& x : book.bodies.front().position()) {
      if (x.x() < -0.04 && x.x() > -0.29 && std::abs(x.y()) < 0.049) lowest = std::min(lowest, x.z());
    }
  }
  return -lowest;
}

TEST(Contact, a_sheet_that_is_folded_onto_itself_does_not_pass_through) {
  for (const bool triangles : {false, true}) {
    EXPECT_EQ(depth(closing_book(ContactOptions{.gap = gap, .damping = 0.3}, triangles)), 0.0);
  }
  EXPECT_GT(depth(closing_book(std::nullopt, false)), 0.05);
}

/// A dome of fabric falls on the ground, a held sheet, and is pushed together on the way.
int crossings_of_collapse(const MaybeContact& contact) {
  Mesh mesh = make_disk({Vec3(0, 0, 0.05), 2, 0.3, {12, 8}, true});
  for (Vec3& p : mesh.nodes) p.z() += 0.15 * std::cos(std::numbers::pi / 0.6 * p.head<2>().norm());
  Hold ground;
  ground.rigid = true;
  const int dome = static_cast<int>(mesh.nodes.size());
  mesh = joined(std::move(mesh), square(Vec3::Zero(), 0.8, 24, true));
  for (int node = dome; node < static_cast<int>(mesh.nodes.size()); ++node) ground.nodes.push_back(node);
  Structure body = sheet(std::move(mesh), {.dissipation = 0.2, .holds = {ground}, .gravity = Vec3(0, 0, -9.81)});
  std::vector<Vec3> v(body.position().size(), Vec3::Zero());
  for (int node = 0; node < dome; ++node) {
    const Vec3 p = body.position()[node];
    v[node] = Vec3(-6.0 * p.x(), -2.0 * p.y(), -1.0);
  }
  body.set_state(copy(body.position()), v);
  Scene canopy = scene(std::move(body), contact);
  int most = 0;
  for (int step = 1; step <= 120; ++step) {
    canopy.advance(2e-3);
    if (step % 40 == 0) most = std::max(most, crossings(std::array{&canopy.bodies.front()}));
  }
  return most;
}

TEST(Contact, a_canopy_that_collapses_does_not_pass_through_itself) {
  EXPECT_EQ(crossings_of_collapse(ContactOptions{.gap = 0.02, .damping = 0.3}), 0);
  EXPECT_GT(crossings_of_collapse(std::nullopt), 100);
}

TEST(Contact, thin_solids_touch_as_pairs_whose_thickness_they_leave_alone) {
  const auto plate = [](double z) { return make_plate({Vec3(0.0, 0.0, z), 2, {0.1, 0.1}, 2e-3, {8, 8, 1}}); };
  Model model =
      one_solid(joined(plate(0.0), plate(0.02)), SaintVenantKirchhoff(1e5, 0.3), 100.0, {}, {.dissipation = 0.0});
  Structure body(std::move(model));
  body.set_inertia(paired(body, 10.0));
  std::vector<Vec3> v(body.position().size());
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = Vec3(0.0, 0.0, body.position()[i].z() > 0.01 ? -0.5 : 0.5);
  body.set_state(copy(body.position()), v);
  Scene plates = scene(std::move(body), ContactOptions{.gap = 6e-3, .stiffness = 0.01});
  const double start = energy_of(plates);
  for (int step = 0; step < 40; ++step) {
    plates.advance(1e-3);
    EXPECT_NEAR(plates.bodies.front().mean_thickness_stretch(), 1.0, 1e-3);
  }
  EXPECT_GT(clearance(plates), 0.01);
  EXPECT_NEAR(synchronised_energy_after(plates, 1e-3) / start, 1.0, 0.02);
}

TEST(Contact, where_nothing_is_near_nothing_changes) {
  Scene with = closing_squares(false), without = closing_squares(false, std::nullopt);
  for (int step = 0; step < 5; ++step) {
    with.advance(1e-3);
    without.advance(1e-3);
  }
  EXPECT_EQ(with.bodies.front().substeps(), without.bodies.front().substeps());
  EXPECT_TRUE(std::ranges::equal(with.bodies.front().position(), without.bodies.front().position()));
}

TEST_P(ClosingSquares, have_the_same_bits_for_any_number_of_threads_and_after_a_restart) {
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  Scene alone = closing_squares(GetParam());
  double nearest = INFINITY;
  for (int step = 0; step < 14; ++step) {
    alone.advance(1e-3);
    nearest = std::min(nearest, clearance(alone));
  }
  omp_set_num_threads(3);
  Scene shared = closing_squares(GetParam());
  for (int step = 0; step < 11; ++step) shared.advance(1e-3);
  Scene restored = closing_squares(GetParam());
  for (std::size_t k = 0; k < shared.bodies.size(); ++k) {
    drogue::testing::copy_state(shared.bodies[k], restored.bodies[k]);
  }
  for (int step = 11; step < 14; ++step) {
    shared.advance(1e-3);
    restored.advance(1e-3);
  }
  omp_set_num_threads(threads);
  for (std::size_t k = 0; k < shared.bodies.size(); ++k) {
    EXPECT_TRUE(std::ranges::equal(alone.bodies[k].position(), shared.bodies[k].position()));
    EXPECT_TRUE(std::ranges::equal(shared.bodies[k].position(), restored.bodies[k].position()));
  }
  EXPECT_LT(nearest, gap);
}

TEST(Contact, bad_options_are_named) {
  EXPECT_THROW(closing_squares(false, ContactOptions{}), InputError);
  EXPECT_THROW(closing_squares(false, ContactOptions{.gap = gap, .stiffness = 0.0}), InputError);
  EXPECT_THROW(closing_squares(false, ContactOptions{.gap = gap, .damping = -1.0}), InputError);
}

TEST(Contact, implicit_motion_is_refused) {
  Model model{square(Vec3::Zero(), 0.2, 4, false), {{"", density, Membrane{fabric, thickness}}}, {}, {}};
  model.options.integrator = Integrator::implicit_scheme;
  EXPECT_THROW(scene(Structure(std::move(model)), ContactOptions{.gap = gap}), InputError);
}

}  // namespace
}  // namespace drogue::fem
