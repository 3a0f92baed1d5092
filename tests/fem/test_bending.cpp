// SPDX-License-Identifier: GPL-3.0-or-later
// Bending, with one hexahedron through the thickness, and what locks: theory of beams and plates, Cook's panel.
#include <gtest/gtest.h>

#include <cmath>

#include "bodies.hpp"

namespace drogue::fem {
namespace {

struct Strip {
  double length = 1.0, width = 0.1, thickness = 0.02;  ///< [m]
  int elements = 24, across = 1;
  double skew = 0.0;  ///< shift of every other line across, one way at one edge and the other way at the other [m]
};

Mesh mesh_of(const Strip& strip) {
  const auto& [length, width, thickness, elements, across, skew] = strip;
  Mesh sheet =
      make_sheet({{Vec3(0, 0, 0), Vec3(length, 0, 0), Vec3(length, width, 0), Vec3(0, width, 0)}, {elements, across}});
  for (Vec3& p : sheet.nodes) {
    const auto line = static_cast<int>(std::lround(p.x() / length * elements));
    if (line % 2 == 1) p.x() += skew * (2.0 * p.y() / width - 1.0);
  }
  return extruded(sheet, Vec3(0, 0, thickness), 1);
}

template <class Rule>
std::vector<int> nodes_where(const Mesh& mesh, const Rule& rule) {
  std::vector<int> nodes;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (rule(mesh.nodes[i])) nodes.push_back(static_cast<int>(i));
  }
  return nodes;
}

Vec3 mean_displacement(const Structure& body, const std::vector<int>& nodes) {
  Vec3 sum = Vec3::Zero();
  for (const int node : nodes) sum += body.position()[node] - body.mesh().nodes[node];
  return sum / static_cast<double>(nodes.size());
}

/// Displacement [m] of the end of a strip, clamped at x = 0, under a dead load [N] across it. `wide`: no strain across
/// the width, as in a wide plate.
Vec3 tip_displacement(const Strip& strip, const Solid& solid, double load, bool wide = false) {
  const Mesh mesh = mesh_of(strip);
  const auto end = nodes_where(mesh, [&](const Vec3& p) { return p.x() > strip.length - 1e-9; });
  const auto clamped = nodes_where(mesh, [](const Vec3& p) { return p.x() < 1e-9; });
  const auto all = nodes_where(mesh, [](const Vec3&) { return true; });
  Loads loads;
  // The clamped end may strain in its plane, as beams do.
  const auto first = [&](double width, double height) {
    return nodes_where(mesh, [&](const Vec3& p) { return p.x() < 1e-9 && p.y() <= width && p.z() <= height; });
  };
  loads.holds.push_back({.nodes = clamped, .rigid = true, .axes = {true, false, false}});
  loads.holds.push_back({.nodes = first(INFINITY, 0.0), .rigid = true, .axes = {false, false, true}});
  loads.holds.push_back({.nodes = wide ? all : first(0.0, 0.0), .rigid = true, .axes = {false, true, false}});
  loads.forces.push_back({end, {Expression(0.0), Expression(0.0), Expression(load)}});
  Structure body(Model{mesh, {{"", 1.0, solid}}, loads, {}});
  body.find_equilibrium(0.0, {.method = Equilibrium::newton, .tolerance = 1e-8});
  return mean_displacement(body, end);
}

double inertia(const Strip& s) { return s.width * std::pow(s.thickness, 3) / 12.0; }

/// Small deflection of a bar of Young's modulus `young` with its shear.
double beam_deflection(const Strip& s, double young, double poisson, double load) {
  return load * std::pow(s.length, 3) / (3.0 * young * inertia(s)) +
         load * s.length * 2.4 * (1.0 + poisson) / (young * s.width * s.thickness);
}

/// Over that of beam theory, with 1 % of the length as deflection.
double relative_deflection(const Strip& strip, const Material& law, Hexahedron element = Hexahedron::assumed_strain) {
  constexpr double young = 1e6, poisson = 0.3;
  const double load = 0.01 * 3.0 * young * inertia(strip);
  return tip_displacement(strip, {law, element}, load).z() / beam_deflection(strip, young, poisson, load);
}

const NeoHookean neo_hookean(1e6, 0.3, 0.3);
const SaintVenantKirchhoff saint_venant_kirchhoff(1e6, 0.3);

TEST(Bending, strips_of_one_layer_bend_like_beams) {
  const Strip strip{.width = 0.08, .elements = 12};  // elements of 4 : 4 : 1
  EXPECT_NEAR(relative_deflection(strip, neo_hookean), 1.0, 0.01);
  EXPECT_NEAR(relative_deflection(strip, saint_venant_kirchhoff), 1.0, 0.01);
  EXPECT_LT(relative_deflection(strip, saint_venant_kirchhoff, Hexahedron::trilinear), 0.2);
}

// No element that passes the patch test is exact in bending if its faces are trapezoids (MacNeal, Finite Elem. Anal.
// Des. 3 (1987) 33); the error falls with the square of the element's size over the thickness.
TEST(Bending, strips_of_trapezoids_converge) {
  const double coarse = relative_deflection({.width = 0.08, .elements = 16, .skew = 0.01}, saint_venant_kirchhoff);
  const double fine =
      relative_deflection({.width = 0.08, .elements = 32, .across = 2, .skew = 0.005}, saint_venant_kirchhoff);
  EXPECT_GT(coarse, 0.8);
  EXPECT_GT(fine, 0.94);
}

TEST(Bending, wide_plates_have_the_stiffness_of_plates_up_to_incompressibility) {
  constexpr double young = 1e6;
  for (const double poisson : {0.0, 0.3, 0.45, 0.4999}) {
    const Strip strip{.width = 0.04, .elements = 25};
    const double plate_young = young / (1.0 - poisson * poisson);
    const double load = 0.01 * 3.0 * plate_young * inertia(strip);
    const Vec3 moved = tip_displacement(strip, {SaintVenantKirchhoff(young, poisson)}, load, true);
    EXPECT_NEAR(moved.z() / beam_deflection(strip, plate_young, 0.0, load), 1.0, 0.01) << "Poisson's ratio " << poisson;
  }
}

// Elastica: deflection and shortening over length at P L^2 / (E I) = 1 and 4.
TEST(Bending, large_deflections_are_those_of_the_elastica) {
  constexpr double young = 1e6;
  const Strip strip{.elements = 25};
  const struct {
    double alpha, deflection, shortening;
  } references[] = {{1.0, 0.301721, 0.056433}, {4.0, 0.669964, 0.328941}};
  for (const auto& [alpha, deflection, shortening] : references) {
    const Vec3 moved = tip_displacement(strip, {SaintVenantKirchhoff(young, 0.0)}, alpha * young * inertia(strip));
    EXPECT_NEAR(moved.z() / deflection, 1.0, 0.01);
    EXPECT_NEAR(-moved.x() / shortening, 1.0, 0.01);
  }
}

/// Upper right corner of Cook's panel [m] in plane strain, scaled to the full load of 6.25 MPa.
double cook(int n, const Solid& solid) {
  constexpr double share = 1e-3;
  const Mesh mesh =
      extruded(make_sheet({{Vec3(0, 0, 0), Vec3(0.048, 0.044, 0), Vec3(0.048, 0.060, 0), Vec3(0, 0.044, 0)}, {n, n}}),
               Vec3(0, 0, 1e-3), 1);
  const auto left = nodes_where(mesh, [](const Vec3& p) { return p.x() < 1e-9; });
  const auto right = nodes_where(mesh, [](const Vec3& p) { return p.x() > 0.048 - 1e-9; });
  const auto corner = nodes_where(mesh, [](const Vec3& p) { return p.x() > 0.048 - 1e-9 && p.y() > 0.060 - 1e-9; });
  Loads loads;
  loads.holds.push_back({.nodes = left, .rigid = true, .axes = {true, true, false}});
  loads.holds.push_back(
      {.nodes = nodes_where(mesh, [](const Vec3&) { return true; }), .rigid = true, .axes = {false, false, true}});
  loads.forces.push_back({right, {Expression(0.0), Expression(share * 100.0), Expression(0.0)}});
  Structure body(Model{mesh, {{"", 1.0, solid}}, loads, {}});
  body.find_equilibrium(0.0, {.method = Equilibrium::newton, .tolerance = 1e-8});
  return mean_displacement(body, corner).y() / share;
}

TEST(Bending, cook_is_within_two_percent_on_16_by_16) {
  EXPECT_NEAR(cook(16, {SaintVenantKirchhoff(70e6, 1.0 / 3.0)}) / 0.03224, 1.0, 0.02);
}

TEST(Bending, cook_does_not_lock_near_incompressibility) {
  const SaintVenantKirchhoff law(70e6, 0.499);
  const double coarse = cook(4, {law}), fine = cook(8, {law}), locked = cook(8, {law, Hexahedron::trilinear});
  // 27.5 mm on 32 x 32
  EXPECT_NEAR(coarse / fine, 1.0, 0.06);
  EXPECT_NEAR(fine / 0.0275, 1.0, 0.05);
  EXPECT_LT(locked / fine, 0.6);
}

}  // namespace
}  // namespace drogue::fem
