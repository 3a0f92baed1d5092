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

TEST(CoupledPoints, a_massless_sheet_is_lifted_by_what_it_displaces_with_which_its_faces_move) {
  const fem::Structure solid = plate({.density = 0.0});
  const fem::Inertia inertia = inertia_of(solid, points_of(solid), fluid_density);
  const auto sum = [](const std::vector<double>& masses) { return std::accumulate(masses.begin(), masses.end(), 0.0); };
  const double displaced = fluid_density * 0.25 * 0.01, dragged = fluid_density * 0.25 * dx * 8.0 / 3.0;
  EXPECT_NEAR(sum(inertia.heavy_mass), -displaced, 1e-12);
  EXPECT_NEAR(sum(inertia.mass), dragged - displaced, 1e-12);
  EXPECT_NEAR(sum(inertia.face_mass), displaced, 1e-12);
  EXPECT_NEAR(inertia.reset, -displaced / (dragged - displaced), 1e-9);
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

/// A square of fabric in the plane z = 0 with a line of 40 cells that ends 40 cells above its middle.
struct Parasol {
  fem::Mesh mesh;
  int sheet_nodes = 0;

  fem::Structure structure(bool line_is_coupled = true) const {
    const fem::OrthotropicFabric fabric(1e6, 1e6, 0.0, 4e5);
    return fem::Structure({mesh,
                           {{"", 500.0, fem::Membrane{fabric, 1e-4}},
                            {"line", 800.0, fem::Cable{{1e6, true}, 1e-6}, {}, line_is_coupled}},
                           {},
                           {}});
  }
};

Parasol parasol() {
  const double half = 8 * dx;
  Parasol body{fem::make_sheet(
      {{Vec3(-half, -half, 0), Vec3(half, -half, 0), Vec3(half, half, 0), Vec3(-half, half, 0)}, {32, 32}})};
  body.sheet_nodes = static_cast<int>(body.mesh.nodes.size());
  const int top = fem::add_point(body.mesh, "top", Vec3(0.0, 0.0, 40 * dx));
  fem::add_line(body.mesh, "line", node_nearest(body.mesh, Vec3::Zero()), top, 80);
  return body;
}

TEST(CoupledPoints, a_membrane_is_one_layer_of_markers_and_a_cable_a_line) {
  const double half = 8 * dx;
  const auto& [mesh, sheet_nodes] = parasol();
  const fem::Structure body = parasol().structure();
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

TEST(CoupledPoints, a_line_drags_the_same_mass_per_length_however_many_markers_it_has) {
  const double per_length = fluid_density * std::pow(dx / ib::sum_phi_squared(ib::Delta::peskin4), 2);
  for (const int elements : {20, 40, 160}) {  // every two cells to four a cell
    fem::Mesh mesh;
    const int from = fem::add_point(mesh, "from", Vec3::Zero()), to = fem::add_point(mesh, "to", Vec3(0, 0, 40 * dx));
    fem::add_line(mesh, "line", from, to, elements);
    const fem::Structure cable({mesh, {{"", 800.0, fem::Cable{{1e6, true}, 1e-6}}}, {}, {}});
    const CoupledPoints points = points_of(cable);
    for (int p = 0; p < points.size(); ++p) {
      const double z = mesh.nodes[points.nodes[p][0]].z();
      if (z < 4 * dx || z > 36 * dx) continue;
      // At two cells the sum over markers is no longer the integral of the delta function's overlap.
      EXPECT_NEAR(points.dragged_mass[p] * elements / (40 * dx * per_length), 1.0, elements == 20 ? 0.02 : 1e-3);
    }
  }
}

TEST(CoupledPoints, nodes_whose_regions_are_all_uncoupled_meet_no_fluid_and_keep_their_own_mass) {
  const auto& [mesh, sheet_nodes] = parasol();
  const fem::Structure body = parasol().structure(false);
  const CoupledPoints points = points_of(body);
  ASSERT_EQ(points.size(), sheet_nodes);
  const CoupledPoints bare = points_of(fem::Structure(
      {fem::make_sheet({{mesh.nodes[0], mesh.nodes[32], mesh.nodes[33 * 33 - 1], mesh.nodes[33 * 32]}, {32, 32}}),
       {{"", 500.0, fem::Membrane{fem::OrthotropicFabric(1e6, 1e6, 0.0, 4e5), 1e-4}}},
       {},
       {}}));
  for (int p = 0; p < points.size(); ++p) EXPECT_NEAR(points.dragged_mass[p] / bare.dragged_mass[p], 1.0, 1e-12);
  // The node they share displaces what the sheet there does, and carries half an element of the line besides.
  const int joint = node_nearest(mesh, Vec3::Zero());
  EXPECT_NEAR(points.excess_mass[joint] - bare.excess_mass[joint], 0.5 * 800.0 * 1e-6 * 0.5 * dx, 1e-15);
  const fem::Inertia inertia = inertia_of(body, points, fluid_density);
  ASSERT_EQ(inertia.point.size(), mesh.nodes.size());
  for (std::size_t p = points.size(); p < inertia.point.size(); ++p) {
    const int node = inertia.point[p][0];
    EXPECT_GE(node, sheet_nodes);
    EXPECT_EQ(inertia.mass[p], body.own_mass()[node]);
    EXPECT_EQ(inertia.heavy_mass[p], body.own_mass()[node]);
  }
}

TEST(CoupledPoints, a_body_that_is_coupled_nowhere_is_refused) {
  fem::Mesh mesh;
  const int from = fem::add_point(mesh, "from", Vec3::Zero()), to = fem::add_point(mesh, "to", Vec3::UnitZ());
  fem::add_line(mesh, "line", from, to, 4);
  const fem::Structure dry({mesh, {{"", 800.0, fem::Cable{{1e6, true}, 1e-6}, {}, false}}, {}, {}});
  EXPECT_THROW(points_of(dry), InputError);
}

TEST(CoupledPoints, a_thick_solid_lighter_than_half_the_fluid_is_rejected_and_a_thin_one_is_not) {
  EXPECT_NO_THROW(points_of(plate({.density = 0.0})));
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
