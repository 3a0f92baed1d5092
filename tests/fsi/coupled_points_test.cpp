// SPDX-License-Identifier: GPL-3.0-or-later
#include "fsi/coupled_points.hpp"

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "core/error.hpp"

namespace drogue::fsi {
namespace {

using namespace drogue::testing;

constexpr double dx = 1.0 / 32;

CoupledPoints points_of(const fem::Structure& solid) {
  return couple_points(solid, ib::Delta::peskin4, dx, fluid_density, "body");
}

fem::Structure cube(double density) {
  return fem::Structure(fem::one_solid(fem::make_plate({Vec3::Zero(), 0, {8 * dx, 8 * dx}, 8 * dx, {8, 8, 8}}),
                                       fem::NeoHookean(1000.0, 0.3, 0.3), density));
}

TEST(CoupledPoints, a_thin_plate_meets_the_fluid_in_pairs_that_drag_the_mass_of_its_area) {
  const fem::Structure solid = plate({});
  const CoupledPoints points = points_of(solid);
  ASSERT_EQ(points.size(), 17 * 17);
  double dragged = 0.0, excess = 0.0;
  for (int p = 0; p < points.size(); ++p) {
    EXPECT_GE(points.nodes[p][1], 0);
    EXPECT_LT((points.normal[p] - Vec3::UnitX()).norm(), 1e-12);
    dragged += points.dragged_mass[p];
    excess += std::abs(points.excess_mass[p]);
  }
  EXPECT_NEAR(dragged, fluid_density * 0.25 * dx * 8.0 / 3.0, 1e-12);
  EXPECT_LT(excess, 1e-12);
}

TEST(CoupledPoints, excess_mass_is_own_mass_less_the_fluid_displaced) {
  const fem::Structure solid = plate({.density = 3.0});
  double excess = 0.0;
  for (double m : points_of(solid).excess_mass) excess += m;
  EXPECT_NEAR(excess, (3.0 - fluid_density) * 0.25 * 0.01, 1e-12);
}

TEST(CoupledPoints, a_thick_solid_meets_the_fluid_in_its_nodes_and_drags_at_least_what_it_displaces) {
  const fem::Structure solid = cube(2.0);
  const CoupledPoints points = points_of(solid);
  ASSERT_EQ(points.size(), 9 * 9 * 9);
  for (int p = 0; p < points.size(); ++p) {
    const int node = points.nodes[p][0];
    EXPECT_EQ(points.nodes[p][1], -1);
    EXPECT_EQ(points.normal[p], Vec3::Zero());
    EXPECT_GE(points.dragged_mass[p], fluid_density * solid.volume()[node] * (1.0 - 1e-9));
  }
}

TEST(CoupledPoints, split_nodes_share_what_their_pair_has) {
  const fem::Structure solid = plate({.density = 3.0});
  const CoupledPoints points = points_of(solid), nodes = split_into_nodes(points);
  ASSERT_EQ(nodes.size(), 2 * points.size());
  for (int p = 0; p < points.size(); ++p) {
    for (int node : points.nodes[p]) {
      EXPECT_EQ(nodes.nodes[node][0], node);
      EXPECT_DOUBLE_EQ(2.0 * nodes.dragged_mass[node], points.dragged_mass[p]);
      EXPECT_DOUBLE_EQ(2.0 * nodes.excess_mass[node], points.excess_mass[p]);
      EXPECT_EQ(nodes.normal[node], points.normal[p]);
    }
  }
}

TEST(CoupledPoints, a_membrane_is_one_layer_of_markers_and_a_cable_a_line) {
  const double half = 8 * dx;
  fem::Mesh mesh = fem::make_sheet(
      {{Vec3(-half, -half, 0), Vec3(half, -half, 0), Vec3(half, half, 0), Vec3(-half, half, 0)}, {32, 32}});
  const int sheet_nodes = static_cast<int>(mesh.nodes.size());
  const int top = fem::add_point(mesh, "top", Vec3(0.0, 0.0, 40 * dx));
  fem::add_line(mesh, "line", node_nearest(mesh, Vec3::Zero()), top, 80);
  const fem::OrthotropicFabric fabric(1e6, 1e6, 0.0, 4e5);
  fem::Model model{
      mesh, {{"", 500.0, fem::Membrane{fabric, 1e-4}}, {"line", 800.0, fem::Cable{{1e6, true}, 1e-6}}}, {}, {}};
  const fem::Structure body(std::move(model));
  const CoupledPoints points = points_of(body);
  ASSERT_EQ(points.size(), static_cast<int>(mesh.nodes.size()));
  const double per_cell = 1.0 / ib::sum_phi_squared(ib::Delta::peskin4);
  for (int p = 0; p < points.size(); ++p) {
    const Vec3& x = mesh.nodes[points.nodes[p][0]];
    if (points.nodes[p][0] < sheet_nodes) {
      if (x.cwiseAbs().maxCoeff() > half - 4 * dx || x.norm() < 6 * dx) continue;
      EXPECT_NEAR(points.dragged_mass[p], fluid_density * 0.25 * dx * dx * dx * per_cell,
                  1e-3 * points.dragged_mass[p]);
      EXPECT_LT((points.normal[p] - Vec3::UnitZ()).norm(), 1e-12);
    } else if (x.z() > 6 * dx && x.z() < 36 * dx) {
      EXPECT_NEAR(points.dragged_mass[p], fluid_density * 0.5 * dx * std::pow(dx * per_cell, 2),
                  1e-3 * points.dragged_mass[p]);
      EXPECT_EQ(points.normal[p], Vec3::Zero());
    }
  }
}

TEST(CoupledPoints, a_thick_solid_lighter_than_half_the_fluid_is_rejected_and_a_thin_one_is_not) {
  EXPECT_NO_THROW(points_of(plate({.density = 1e-3})));
  EXPECT_NO_THROW(points_of(cube(0.51 * fluid_density)));
  try {
    points_of(cube(0.4 * fluid_density));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("body 'body': node "), std::string::npos) << message;
    EXPECT_NE(message.find("use a denser solid"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace drogue::fsi
