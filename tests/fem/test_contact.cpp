// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of surfaces with each other and with themselves.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <numbers>

#include "../core/memory_archive.hpp"
#include "bodies.hpp"
#include "core/error.hpp"

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
  std::optional<ContactOptions> contact = ContactOptions{.gap = gap};
  double dissipation = 0.0;
  std::vector<Hold> holds{};
  Vec3 gravity = Vec3::Zero();
};

Structure sheets(Mesh mesh, const SheetOptions& options) {
  Model model{std::move(mesh), {{"", density, Membrane{fabric, thickness}}}, {}, {.dissipation = options.dissipation}};
  model.loads.contact = options.contact;
  model.loads.holds = options.holds;
  model.loads.gravity = options.gravity;
  return Structure(std::move(model));
}

/// Two parallel squares, one of quadrilaterals and one of triangles, that close in at 2 m/s.
Structure closing_squares(const SheetOptions& options) {
  Mesh mesh = joined(square(Vec3::Zero(), 0.2, 10, false), square(Vec3(0.003, -0.002, 0.03), 0.2, 9, true));
  Structure body = sheets(std::move(mesh), options);
  std::vector<Vec3> v(body.position().size());
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = Vec3(0.0, 0.0, body.position()[i].z() > 0.01 ? -1.0 : 1.0);
  body.set_state(copy(body.position()), v);
  return body;
}

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

Momenta momenta(const Structure& body) {
  Momenta sum;
  for (std::size_t i = 0; i < body.position().size(); ++i) {
    const Vec3 momentum = body.own_mass()[i] * body.velocity()[i];
    sum.linear += momentum;
    sum.angular += body.position()[i].cross(momentum);
  }
  return sum;
}

/// Lowest node of the upper square less the highest of the lower one.
double clearance(const Structure& body) {
  double lowest = INFINITY, highest = -INFINITY;
  for (std::size_t i = 0; i < body.position().size(); ++i) {
    const double z = body.position()[i].z();
    (body.mesh().nodes[i].z() > 0.01 ? lowest : highest) =
        body.mesh().nodes[i].z() > 0.01 ? std::min(lowest, z) : std::max(highest, z);
  }
  return lowest - highest;
}

TEST(Contact, sheets_that_meet_part_again_with_their_momenta_and_energy) {
  Structure body = closing_squares({});
  const Momenta before = momenta(body);
  const double start = energy(body);
  double nearest = INFINITY;
  for (int step = 0; step < 30; ++step) {
    body.advance(1e-3, 0.0);
    nearest = std::min(nearest, clearance(body));
  }
  EXPECT_LT(nearest, gap);
  EXPECT_GT(clearance(body), gap);
  const Momenta after = momenta(body);
  const double scale = density * thickness * 0.04;  // of one square at 1 m/s
  EXPECT_LT((after.linear - before.linear).norm(), 1e-12 * scale);
  EXPECT_LT((after.angular - before.angular).norm(), 1e-13 * scale);
  EXPECT_NEAR(synchronised_energy(body, 1e-3 / body.substeps()) / start, 1.0, 0.02);
}

TEST(Contact, without_it_they_pass_through_each_other) {
  Structure body = closing_squares({.contact = std::nullopt});
  for (int step = 0; step < 30; ++step) body.advance(1e-3, 0.0);
  EXPECT_LT(clearance(body), 0.0);
}

TEST(Contact, damping_takes_energy_and_no_momentum) {
  Structure body = closing_squares({.contact = ContactOptions{.gap = gap, .damping = 0.5}});
  const double start = energy(body);
  const Momenta before = momenta(body);
  for (int step = 0; step < 30; ++step) body.advance(1e-3, 0.0);
  EXPECT_GT(clearance(body), 0.0);
  EXPECT_LT(energy(body), 0.8 * start);
  EXPECT_LT((momenta(body).linear - before.linear).norm(), 1e-13);
  EXPECT_LT((momenta(body).angular - before.angular).norm(), 1e-13);
}

TEST(Contact, the_sub_step_hardly_shrinks_while_they_touch) {
  Structure body = closing_squares({});
  const double apart = body.stable_step();
  double shortest = apart;
  for (int step = 0; step < 30; ++step) {
    body.advance(1e-3, 0.0);
    shortest = std::min(shortest, body.stable_step());
  }
  EXPECT_LT(shortest, apart);
  EXPECT_GT(shortest, 0.9 * apart);
}

/// A strip, of which one half lies held and the other is thrown over onto it.
Structure closing_book(const std::optional<ContactOptions>& contact, bool triangles) {
  Mesh mesh = make_sheet(
      {{Vec3(-0.3, -0.05, 0), Vec3(0.3, -0.05, 0), Vec3(0.3, 0.05, 0), Vec3(-0.3, 0.05, 0)}, {31, 5}, triangles});
  Hold lying;
  lying.rigid = true;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (mesh.nodes[i].x() < 0.0) lying.nodes.push_back(static_cast<int>(i));
  }
  Structure body =
      sheets(std::move(mesh), {.contact = contact, .dissipation = 0.2, .holds = {lying}, .gravity = Vec3(0, 0, -9.81)});
  std::vector<Vec3> v(body.position().size(), Vec3::Zero());
  for (std::size_t i = 0; i < v.size(); ++i) v[i].z() = 20.0 * std::max(0.0, body.position()[i].x());
  body.set_state(copy(body.position()), v);
  return body;
}

/// How far below the lying half the other one reaches, away from the fold.
double depth(const Structure& body) {
  double lowest = 0.0;
  for (const Vec3& x : body.position()) {
    if (x.x() < -0.04 && x.x() > -0.29 && std::abs(x.y()) < 0.049) lowest = std::min(lowest, x.z());
  }
  return -lowest;
}

TEST(Contact, a_sheet_that_is_folded_onto_itself_does_not_pass_through) {
  for (const bool triangles : {false, true}) {
    Structure body = closing_book(ContactOptions{.gap = gap, .damping = 0.3}, triangles);
    double deepest = 0.0;
    for (int step = 0; step < 250; ++step) {
      body.advance(2e-3, 0.0);
      deepest = std::max(deepest, depth(body));
    }
    EXPECT_EQ(deepest, 0.0);
  }
  Structure free = closing_book(std::nullopt, false);
  double deepest = 0.0;
  for (int step = 0; step < 250; ++step) {
    free.advance(2e-3, 0.0);
    deepest = std::max(deepest, depth(free));
  }
  EXPECT_GT(deepest, 0.05);
}

bool crosses(const Vec3& from, const Vec3& to, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto volume = [](const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    return (q - p).cross(r - p).dot(s - p);
  };
  if (volume(a, b, c, from) * volume(a, b, c, to) >= 0.0) return false;
  const double u = volume(from, to, a, b), v = volume(from, to, b, c), w = volume(from, to, c, a);
  return (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
}

/// How often edges of triangles pass through triangles.
int crossings(const Structure& body) {
  const auto& x = body.position();
  int count = 0;
  for (const auto& face : body.mesh().triangles) {
    for (const auto& other : body.mesh().triangles) {
      for (int k = 0; k < 3; ++k) {
        const int from = face[k], to = face[(k + 1) % 3];
        if (std::ranges::find(other, from) != other.end() || std::ranges::find(other, to) != other.end()) continue;
        count += crosses(x[from], x[to], x[other[0]], x[other[1]], x[other[2]]);
      }
    }
  }
  return count;
}

/// A dome of fabric falls on the ground, a held sheet, and is pushed together on the way.
int crossings_of_collapse(const std::optional<ContactOptions>& contact) {
  Mesh mesh = make_disk({Vec3(0, 0, 0.05), 2, 0.3, {12, 8}, true});
  for (Vec3& p : mesh.nodes) p.z() += 0.15 * std::cos(std::numbers::pi / 0.6 * p.head<2>().norm());
  Hold ground;
  ground.rigid = true;
  const int dome = static_cast<int>(mesh.nodes.size());
  mesh = joined(std::move(mesh), square(Vec3::Zero(), 0.8, 24, true));
  for (int node = dome; node < static_cast<int>(mesh.nodes.size()); ++node) ground.nodes.push_back(node);
  Structure body = sheets(std::move(mesh),
                          {.contact = contact, .dissipation = 0.2, .holds = {ground}, .gravity = Vec3(0, 0, -9.81)});
  std::vector<Vec3> v(body.position().size(), Vec3::Zero());
  for (int node = 0; node < dome; ++node) {
    const Vec3 p = body.position()[node];
    v[node] = Vec3(-6.0 * p.x(), -2.0 * p.y(), -1.0);
  }
  body.set_state(copy(body.position()), v);
  int most = 0;
  for (int step = 1; step <= 120; ++step) {
    body.advance(2e-3, 0.0);
    if (step % 40 == 0) most = std::max(most, crossings(body));
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
  model.loads.contact = ContactOptions{.gap = 6e-3, .stiffness = 0.01};
  Structure body(std::move(model));
  body.set_inertia(paired(body, 10.0));
  std::vector<Vec3> v(body.position().size());
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = Vec3(0.0, 0.0, body.position()[i].z() > 0.01 ? -0.5 : 0.5);
  body.set_state(copy(body.position()), v);
  const double start = energy(body);
  for (int step = 0; step < 40; ++step) {
    body.advance(1e-3, 0.0);
    EXPECT_NEAR(body.mean_thickness_stretch(), 1.0, 1e-3);
  }
  EXPECT_GT(clearance(body), 0.01);
  EXPECT_NEAR(synchronised_energy(body, 1e-3 / body.substeps()) / start, 1.0, 0.02);
}

TEST(Contact, where_nothing_is_near_nothing_changes) {
  Structure with = closing_squares({}), without = closing_squares({.contact = std::nullopt});
  for (int step = 0; step < 5; ++step) {
    with.advance(1e-3, 0.0);
    without.advance(1e-3, 0.0);
  }
  EXPECT_EQ(with.substeps(), without.substeps());
  EXPECT_TRUE(std::ranges::equal(with.position(), without.position()));
}

TEST(Contact, same_bits_for_any_number_of_threads_and_after_a_restart) {
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  Structure alone = closing_squares({});
  double nearest = INFINITY;
  for (int step = 0; step < 14; ++step) {
    alone.advance(1e-3, 0.0);
    nearest = std::min(nearest, clearance(alone));
  }
  omp_set_num_threads(3);
  Structure shared = closing_squares({});
  for (int step = 0; step < 11; ++step) shared.advance(1e-3, 0.0);
  Structure restored = closing_squares({});
  drogue::testing::copy_state(shared, restored);
  for (int step = 11; step < 14; ++step) {
    shared.advance(1e-3, 0.0);
    restored.advance(1e-3, 0.0);
  }
  omp_set_num_threads(threads);
  EXPECT_TRUE(std::ranges::equal(alone.position(), shared.position()));
  EXPECT_TRUE(std::ranges::equal(shared.position(), restored.position()));
  EXPECT_LT(nearest, gap);
}

TEST(Contact, bad_options_are_named) {
  EXPECT_THROW(closing_squares({.contact = ContactOptions{}}), InputError);
  EXPECT_THROW(closing_squares({.contact = ContactOptions{.gap = gap, .stiffness = 0.0}}), InputError);
  EXPECT_THROW(closing_squares({.contact = ContactOptions{.gap = gap, .damping = -1.0}}), InputError);
}

}  // namespace
}  // namespace drogue::fem
