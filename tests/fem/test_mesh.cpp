// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <numeric>

#include "bodies.hpp"
#include "core/error.hpp"

namespace drogue::fem {
namespace {

TEST(Mesh, plate_has_its_size_place_and_orientation_about_every_axis) {
  for (int normal = 0; normal < 3; ++normal) {
    const Vec3 centre(1.0, -2.0, 0.5);
    const Mesh mesh = make_plate({centre, normal, {0.6, 0.4}, 0.01, {6, 4, 2}});
    EXPECT_EQ(mesh.nodes.size(), 7u * 5u * 3u);
    EXPECT_EQ(mesh.hexahedra.size(), 6u * 4u * 2u);
    Box box{mesh.nodes[0], mesh.nodes[0]};
    for (const Vec3& p : mesh.nodes) box = {box.lower.cwiseMin(p), box.upper.cwiseMax(p)};
    EXPECT_NEAR(box.size()[normal], 0.01, 1e-15);
    EXPECT_NEAR(box.size()[(normal + 1) % 3], 0.6, 1e-15);
    EXPECT_NEAR(box.size()[(normal + 2) % 3], 0.4, 1e-15);
    EXPECT_LT((0.5 * (box.lower + box.upper) - centre).norm(), 1e-15);
    // The structure refuses inverted elements.
    const Structure body = solid(mesh, NeoHookean(1e3, 0.3, 0.3), {.density = 2.0}, {});
    const auto volume = body.volume();
    EXPECT_NEAR(std::accumulate(volume.begin(), volume.end(), 0.0), 0.6 * 0.4 * 0.01, 1e-16);
    EXPECT_NEAR(body.own_mass()[0], 2.0 * 0.1 * 0.1 * 0.005 / 8.0, 1e-18);
  }
}

TEST(Mesh, impossible_plates_are_refused) {
  EXPECT_THROW(make_plate({Vec3::Zero(), 3, {1.0, 1.0}, 0.1, {1, 1, 1}}), InputError);
  EXPECT_THROW(make_plate({Vec3::Zero(), 0, {1.0, 0.0}, 0.1, {1, 1, 1}}), InputError);
  EXPECT_THROW(make_plate({Vec3::Zero(), 0, {1.0, 1.0}, -0.1, {1, 1, 1}}), InputError);
  EXPECT_THROW(make_plate({Vec3::Zero(), 0, {1.0, 1.0}, 0.1, {1, 0, 1}}), InputError);
}

TEST(Mesh, corner_patch_grows_with_its_length) {
  const Mesh mesh = make_plate({Vec3::Zero(), 0, {0.8128, 0.8128}, 5e-3, {52, 52, 1}});
  const double h = 0.8128 / 52;
  EXPECT_EQ(corner_nodes(mesh, 0.0).size(), 8u);
  EXPECT_EQ(corner_nodes(mesh, 0.99 * h).size(), 8u);
  EXPECT_EQ(corner_nodes(mesh, h).size(), 4u * 4u * 2u);
  EXPECT_EQ(corner_nodes(mesh, 2.5 * h).size(), 4u * 9u * 2u);
  for (const int node : corner_nodes(mesh, h)) {
    EXPECT_GE(std::abs(mesh.nodes[node].y()), 0.4064 - 1.001 * h);
    EXPECT_GE(std::abs(mesh.nodes[node].z()), 0.4064 - 1.001 * h);
  }
}

TEST(Mesh, pairs_join_the_faces_of_a_thin_solid) {
  const Mesh mesh = make_plate({Vec3::Zero(), 1, {0.6, 0.4}, 0.01, {6, 4, 1}});
  const auto pairs = thickness_pairs(mesh, 0.01);
  ASSERT_EQ(pairs.size(), 7u * 5u);
  for (const auto& [a, b] : pairs) {
    EXPECT_LT(a, b);
    EXPECT_LT((mesh.nodes[b] - mesh.nodes[a] - Vec3(0.0, 0.01, 0.0)).norm(), 1e-15);
  }
  EXPECT_TRUE(thickness_pairs(mesh, 0.009).empty());
  EXPECT_TRUE(thickness_pairs(make_plate({Vec3::Zero(), 1, {0.6, 0.4}, 0.01, {6, 4, 2}}), 1.0).empty());
}

TEST(Mesh, pairs_of_a_strip_one_element_wide_span_its_thickness) {
  const Mesh mesh = block({1.0, 0.1, 0.02}, {10, 1, 1});
  const auto pairs = thickness_pairs(mesh, 1.0);
  ASSERT_EQ(pairs.size(), 22u);
  for (const auto& [a, b] : pairs) EXPECT_NEAR((mesh.nodes[b] - mesh.nodes[a]).norm(), 0.02, 1e-15);
}

TEST(Mesh, pair_areas_sum_to_the_area_of_the_middle_surface) {
  Mesh mesh = make_plate({Vec3::Zero(), 2, {0.6, 0.4}, 0.01, {6, 4, 1}});
  auto pairs = thickness_pairs(mesh, 0.02);
  auto areas = pair_areas(mesh, pairs);
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), 0.24, 1e-14);
  EXPECT_NEAR(areas[0], 0.25 * 0.01, 1e-15);
  EXPECT_NEAR(areas[8], 0.01, 1e-15);

  // Rolled into an arc of 1 rad and radius 0.6 m at mid-thickness: faces at 0.595 and 0.605 m, by chords.
  for (Vec3& p : mesh.nodes) p = {(0.6 + p.z()) * std::sin(p.x() / 0.6), p.y(), (0.6 + p.z()) * std::cos(p.x() / 0.6)};
  pairs = thickness_pairs(mesh, 0.02);
  areas = pair_areas(mesh, pairs);
  EXPECT_EQ(pairs.size(), 35u);
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), 0.4 * 0.6 * 12.0 * std::sin(1.0 / 12.0), 1e-13);
}

}  // namespace
}  // namespace drogue::fem
