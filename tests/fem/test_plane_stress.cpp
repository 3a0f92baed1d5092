// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/plane_stress.hpp"

#include <gtest/gtest.h>

#include "bodies.hpp"

namespace drogue::fem {
namespace {

const NeoHookean neo_hookean(1000.0, 0.3, 0.3);
const SaintVenantKirchhoff saint_venant_kirchhoff(1000.0, 0.3);

// The equibiaxial table of the reference page, computed independently.
TEST(PlaneStress, equibiaxial_thickness_follows_the_reference_table) {
  EXPECT_NEAR(plane_stress_thickness(neo_hookean, 0.9, 0.9), 1.08881, 1e-5);
  EXPECT_NEAR(plane_stress_thickness(neo_hookean, 1.1, 1.1), 0.91818, 1e-5);
  EXPECT_NEAR(plane_stress_thickness(neo_hookean, 1.5, 1.5), 0.67499, 1e-5);
  EXPECT_NEAR(plane_stress_thickness(saint_venant_kirchhoff, 0.9, 0.9), 1.07836, 1e-5);
  EXPECT_NEAR(plane_stress_thickness(saint_venant_kirchhoff, 1.3, 1.3), 0.63920, 1e-5);
}

TEST(PlaneStress, a_sheet_beyond_the_range_of_the_law_has_no_thickness) {
  EXPECT_EQ(plane_stress_thickness(saint_venant_kirchhoff, 1.6, 1.6), 0.0);
}

TEST(PlaneStress, stretches_of_a_sheet_do_not_depend_on_rotation_and_shear_across_it) {
  const Mesh sheet = make_plate({Vec3::Zero(), 1, {0.4, 0.3}, 0.01, {4, 3, 1}});
  Mat3 f = Vec3(1.2, 0.8, 0.9).asDiagonal();
  f(0, 1) = 0.3;  // slides one face over the other, which leaves their distance
  const auto x = mapped(sheet.nodes, rotation(1.1, Vec3(1, 2, 3)) * f);
  const SheetStretch stretch = sheet_stretch(sheet.hexahedra[5], 2, sheet.nodes, x);
  EXPECT_NEAR(stretch.thickness, 0.8, 1e-12);
  EXPECT_NEAR(stretch.in_plane[0], 0.9, 1e-12);
  EXPECT_NEAR(stretch.in_plane[1], 1.2, 1e-12);
}

TEST(PlaneStress, a_sheet_of_free_thickness_compares_as_such) {
  const Mesh mesh = block({0.4, 0.4, 0.01}, {4, 4, 1});
  Structure sheet = solid(mesh, neo_hookean, {.density = 1.0}, {});
  const double free = plane_stress_thickness(neo_hookean, 1.1, 0.95);
  const auto place = [&](double thickness) {
    const auto x = mapped(mesh.nodes, Vec3(1.1, 0.95, thickness).asDiagonal());
    sheet.set_state(x, std::vector<Vec3>(x.size(), Vec3::Zero()));
    return sheet.plane_stress_comparison();
  };
  EXPECT_EQ(place(free)[0], 1.0);  // no pairs yet
  sheet.set_inertia(paired(sheet, 3.0));
  EXPECT_NEAR(place(free)[0], free, 1e-12);
  EXPECT_NEAR(place(free)[1], 0.0, 1e-12);
  EXPECT_NEAR(place(1.02 * free)[1], 0.02, 1e-12);
}

}  // namespace
}  // namespace drogue::fem
