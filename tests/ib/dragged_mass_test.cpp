// SPDX-License-Identifier: GPL-3.0-or-later
#include "ib/dragged_mass.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fake_fluid.hpp"
#include "ib/markers.hpp"

namespace drogue::ib {
namespace {

using drogue::testing::cube_of_fine_blocks;

constexpr double dx = 1.0 / 32, density = 1.2;

struct Cloud {
  std::vector<Vec3> position;
  std::vector<double> volume;
};

/// n[0] x n[1] x n[2] markers, `spacing` apart; the outermost own half a cell (a quarter at edges, an eighth at
/// corners).
Cloud lattice(const Index3& n, double spacing) {
  Cloud cloud;
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        const Index3 at{i, j, k};
        double volume = spacing * spacing * spacing;
        for (int a = 0; a < 3; ++a) {
          if (n[a] > 1 && (at[a] == 0 || at[a] == n[a] - 1)) volume *= 0.5;
        }
        cloud.position.push_back(spacing * Vec3(i - 0.5 * (n[0] - 1), j - 0.5 * (n[1] - 1), k - 0.5 * (n[2] - 1)));
        cloud.volume.push_back(volume);
      }
    }
  }
  return cloud;
}

std::vector<double> dragged_by(Delta delta, const Cloud& cloud) {
  return mass_dragged_by_cloud(delta, cloud.position, cloud.volume, dx, density);
}

class MassOfBothDeltas : public ::testing::TestWithParam<Delta> {};

TEST_P(MassOfBothDeltas, a_marker_on_its_own_drags_what_its_delta_covers) {
  const Cloud one{{Vec3(0.3, 0.2, 0.1)}, {1e-6}};
  EXPECT_NEAR(dragged_by(GetParam(), one)[0] / (density * std::pow(dx / sum_phi_squared(GetParam()), 3)), 1.0, 1e-9);
}

TEST_P(MassOfBothDeltas, inside_a_volume_markers_drag_the_fluid_they_stand_for_and_at_its_faces_twice_that) {
  const int n = 13;
  const Cloud cube = lattice({n, n, n}, dx);
  const auto mass = dragged_by(GetParam(), cube);
  const auto at = [&](int i, int j, int k) { return (k * n + j) * n + i; };
  const int centre = at(6, 6, 6), face = at(0, 6, 6);
  EXPECT_NEAR(mass[centre] / (density * cube.volume[centre]), 1.0, 1e-9);
  EXPECT_NEAR(mass[face] / (density * cube.volume[face]), 2.0, 1e-9);
}

TEST_P(MassOfBothDeltas, a_single_layer_drags_what_a_sheet_drags) {
  const Cloud layer = lattice({1, 17, 17}, dx);
  const auto mass = dragged_by(GetParam(), layer);
  const std::vector<double> area{dx * dx};
  const double sheet = mass_dragged_by_sheet(GetParam(), area, dx, density)[0];
  EXPECT_DOUBLE_EQ(sheet, density * dx * dx * dx / sum_phi_squared(GetParam()));
  EXPECT_NEAR(mass[8 * 17 + 8] / sheet, 1.0, 1e-9);
}

/// Largest gain by which impulses M_l change the velocity of the markers (power iteration on the real grid).
double largest_gain(Delta delta, const Cloud& cloud, const std::vector<double>& mass, const Vec3& shift) {
  const amr::Forest forest = cube_of_fine_blocks();
  auto places = cloud.position;
  for (Vec3& p : places) p += shift;
  Markers markers(forest, delta, "cloud");
  markers.move_to(places);
  std::vector<Vec3> u(places.size(), Vec3::UnitX()), force(places.size());
  double gain = 0.0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    for (std::size_t l = 0; l < u.size(); ++l) force[l] = mass[l] / density * u[l];
    fluid::ForceField f(forest);
    markers.spread(force, f);
    markers.interpolate(f, u);
    gain = 0.0;
    for (const Vec3& v : u) gain = std::max(gain, std::abs(v.x()));
    for (Vec3& v : u) v /= gain;
  }
  return gain;
}

TEST_P(MassOfBothDeltas, no_velocity_is_corrected_by_more_than_its_error) {
  // Row sums are one on the mean over the places of the grid; at a given place they may be a few percent more.
  const std::vector<std::pair<Index3, double>> lattices{
      {{9, 9, 9}, dx}, {{2, 12, 12}, dx}, {{1, 12, 12}, 0.5 * dx}, {{3, 8, 8}, 1.37 * dx}, {{1, 5, 5}, 3.0 * dx}};
  for (const auto& [n, spacing] : lattices) {
    const Cloud cloud = lattice(n, spacing);
    const auto mass = dragged_by(GetParam(), cloud);
    for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(0.3 * dx, 0.5 * dx, 0.21 * dx)}) {
      EXPECT_LT(largest_gain(GetParam(), cloud, mass, shift), 1.05) << n[0] << " layers " << spacing / dx;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Delta, MassOfBothDeltas, ::testing::Values(Delta::peskin4, Delta::peskin3),
                         [](const auto& test) { return test.param == Delta::peskin4 ? "peskin4" : "peskin3"; });

}  // namespace
}  // namespace drogue::ib
