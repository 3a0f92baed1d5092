// SPDX-License-Identifier: GPL-3.0-or-later
#include "ib/markers.hpp"

#include <gtest/gtest.h>
#include <omp.h>
#include <Eigen/Geometry>

#include <cstring>
#include <limits>
#include <random>

#include "core/error.hpp"
#include "fake_fluid.hpp"

namespace drogue::ib {
namespace {

using drogue::testing::cube_of_fine_blocks;
using drogue::testing::each_forced_cell;
using drogue::testing::FakeFluid;
using drogue::testing::periodic_box;

constexpr double float_epsilon = std::numeric_limits<float>::epsilon();

std::vector<Vec3> random_vectors(int count, double bound, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-bound, bound);
  std::vector<Vec3> vectors(count);
  for (Vec3& v : vectors) v = Vec3(unit(random), unit(random), unit(random));
  return vectors;
}

/// Inside a block, and near the faces, edges and corners where blocks meet.
std::vector<Vec3> places_of_every_kind(double spacing) {
  std::vector<Vec3> places{{0.2, 0.3, -0.3}, {0.25, 0.25, 0.25}};
  for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(0.5, 0, -0.5), Vec3(0.5, 0.27, 0.5), Vec3(0.22, -0.5, 0.24)}) {
    for (const Vec3& shift : random_vectors(40, 2.5 * spacing, 7)) places.push_back(corner + shift);
    places.push_back(corner);
  }
  return places;
}

class MarkersOfBothDeltas : public ::testing::TestWithParam<Delta> {
 protected:
  Markers markers_at(const amr::Forest& forest, const std::vector<Vec3>& places) {
    Markers markers(forest, GetParam(), "sheet");
    markers.move_to(places);
    return markers;
  }
};

TEST_P(MarkersOfBothDeltas, interpolation_reproduces_linear_fields) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest);
  const Mat3 gradient{{1.0, -2.0, 0.5}, {0.3, 0.7, -1.1}, {-0.4, 2.0, 1.0}};
  const Vec3 constant(1.0, -0.5, 0.25);
  const auto linear = [&](const Vec3& x) -> Vec3 { return constant + gradient * x; };
  fluid.fill(linear);

  auto places = places_of_every_kind(fluid.spacing());
  for (const Vec3& p : random_vectors(500, 0.9, 3)) places.push_back(p);
  std::vector<Vec3> u(places.size());
  markers_at(forest, places).interpolate(fluid.view(), u);
  for (std::size_t l = 0; l < u.size(); ++l) {
    EXPECT_LT((u[l] - linear(places[l])).norm(), 4.0 * float_epsilon) << places[l].transpose();
  }
}

TEST_P(MarkersOfBothDeltas, spreading_is_adjoint_to_interpolation) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest);
  fluid.fill_at_random(11);
  const auto places = places_of_every_kind(fluid.spacing());
  const auto forces = random_vectors(static_cast<int>(places.size()), 1.0, 5);
  const Markers markers = markers_at(forest, places);

  std::vector<Vec3> u(places.size());
  markers.interpolate(fluid.view(), u);
  double at_markers = 0.0, size = 0.0;
  for (std::size_t l = 0; l < u.size(); ++l) {
    at_markers += u[l].dot(forces[l]);
    size += std::abs(u[l].dot(forces[l]));
  }

  fluid::ForceField f(forest);
  markers.spread(forces, f);
  double on_grid = 0.0;
  const auto view = fluid.view();
  each_forced_cell(forest, f, [&](const Vec3& x, const Vec3& force) {
    const auto [block, cell] = *forest.locate(x);
    const float* at = view.block(block) + cell[2] * view.stride_z + cell[1] * view.stride_y + cell[0];
    for (int a = 0; a < 3; ++a) on_grid += view.scale * at[a * view.stride_component] * force[a] * fluid.cell_volume();
  });
  EXPECT_NEAR(on_grid, at_markers, 10.0 * float_epsilon * size);
}

TEST_P(MarkersOfBothDeltas, spreading_conserves_force_and_torque) {
  const amr::Forest forest = cube_of_fine_blocks();
  const auto places = places_of_every_kind(1.0 / 32);
  const auto forces = random_vectors(static_cast<int>(places.size()), 1.0, 9);
  fluid::ForceField f(forest);
  markers_at(forest, places).spread(forces, f);

  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  for (std::size_t l = 0; l < places.size(); ++l) {
    force += forces[l];
    torque += places[l].cross(forces[l]);
  }
  each_forced_cell(forest, f, [&](const Vec3& x, const Vec3& per_volume) {
    const Vec3 of_cell = per_volume / (32.0 * 32.0 * 32.0);
    force -= of_cell;
    torque -= x.cross(of_cell);
  });
  const double size = static_cast<double>(places.size());
  EXPECT_LT(force.norm(), float_epsilon * size);
  EXPECT_LT(torque.norm(), float_epsilon * size);
}

TEST_P(MarkersOfBothDeltas, stencils_across_blocks_equal_the_sum_over_all_cells) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest);
  fluid.fill_at_random(2);
  const auto places = places_of_every_kind(fluid.spacing());
  std::vector<Vec3> u(places.size());
  markers_at(forest, places).interpolate(fluid.view(), u);

  std::vector<Vec3> expected(places.size(), Vec3::Zero());
  fluid.each_cell([&](const Vec3& x, auto value) {
    for (std::size_t l = 0; l < places.size(); ++l) {
      const Vec3 r = (x - places[l]) / fluid.spacing();
      if (r.cwiseAbs().maxCoeff() > 2.0) continue;
      double weight = 1.0;
      for (int a = 0; a < 3; ++a) {
        // The cell at distance r from a marker at the origin is the cell 0 of a marker at -r.
        const AxisWeights axis = axis_weights(GetParam(), -r[a]);
        weight *= -axis.low >= 0 && -axis.low < 4 ? axis.weight[-axis.low] : 0.0;
      }
      expected[l] += weight * double{fluid.view().scale} * Vec3(value(0), value(1), value(2));
    }
  });
  for (std::size_t l = 0; l < u.size(); ++l) EXPECT_LT((u[l] - expected[l]).norm(), 1e-7) << places[l].transpose();
}

TEST_P(MarkersOfBothDeltas, periodic_axes_wrap) {
  const amr::Forest forest = periodic_box();
  FakeFluid fluid(forest);
  fluid.fill_at_random(3);
  auto places = random_vectors(300, 1.0, 4);
  std::vector<Vec3> here(places.size()), image(places.size());
  markers_at(forest, places).interpolate(fluid.view(), here);
  for (Vec3& p : places) p += Vec3(2, -3, 1);
  const Markers moved = markers_at(forest, places);
  moved.interpolate(fluid.view(), image);
  for (std::size_t l = 0; l < here.size(); ++l) EXPECT_LT((here[l] - image[l]).norm(), 1e-12);

  fluid::ForceField f(forest);
  moved.spread(std::vector<Vec3>(places.size(), Vec3::UnitX()), f);
  Vec3 force = Vec3::Zero();
  each_forced_cell(forest, f, [&](const Vec3&, const Vec3& per_volume) { force += per_volume * fluid.cell_volume(); });
  EXPECT_NEAR(force.x(), 300.0, 300.0 * float_epsilon);
}

TEST_P(MarkersOfBothDeltas, same_bits_for_any_number_of_threads) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest);
  fluid.fill_at_random(6);
  const auto places = random_vectors(2000, 0.6, 13), forces = random_vectors(2000, 1.0, 14);
  const int threads_before = omp_get_max_threads();

  std::vector<Vec3> first_u;
  std::vector<std::vector<float>> first_f;
  for (int threads : {1, 2, 4}) {
    omp_set_num_threads(threads);
    const Markers markers = markers_at(forest, places);
    std::vector<Vec3> u(places.size());
    markers.interpolate(fluid.view(), u);
    fluid::ForceField field(forest);
    markers.spread(forces, field);
    std::vector<std::vector<float>> f;
    for (int id : field.opened()) f.emplace_back(field.block(id), field.block(id) + fluid::ForceField::block_floats);
    if (threads == 1) {
      first_u = u;
      first_f = f;
    }
    EXPECT_EQ(u, first_u);
    EXPECT_EQ(f, first_f);
  }
  omp_set_num_threads(threads_before);
}

TEST_P(MarkersOfBothDeltas, moving_step_by_step_ends_like_starting_there) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest);
  fluid.fill_at_random(8);
  auto places = random_vectors(400, 0.4, 17);
  const auto forces = random_vectors(400, 1.0, 18), drift = random_vectors(400, 0.04, 19);
  Markers markers(forest, GetParam(), "sheet");
  for (int step = 0; step < 12; ++step) {
    markers.move_to(places);
    for (std::size_t l = 0; l < places.size(); ++l) places[l] += drift[l];
  }
  markers.move_to(places);

  std::vector<Vec3> u(places.size()), fresh_u(places.size());
  fluid::ForceField f(forest), fresh_f(forest);
  markers.interpolate(fluid.view(), u);
  markers.spread(forces, f);
  const Markers fresh = markers_at(forest, places);
  fresh.interpolate(fluid.view(), fresh_u);
  fresh.spread(forces, fresh_f);
  EXPECT_EQ(u, fresh_u);
  ASSERT_EQ(f.opened().size(), fresh_f.opened().size());
  for (int id : f.opened()) {
    EXPECT_EQ(std::memcmp(f.block(id), fresh_f.block(id), fluid::ForceField::block_floats * sizeof(float)), 0);
  }
}

TEST_P(MarkersOfBothDeltas, a_force_field_is_interpolated_like_a_velocity_and_is_zero_where_not_open) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest);
  fluid.fill([](const Vec3&) { return Vec3(1, 2, 3); });
  const std::vector<Vec3> near{{0.25, 0.25, 0.25}}, far{{-0.25, -0.25, -0.25}};
  fluid::ForceField f(forest);
  const Markers markers = markers_at(forest, near);
  markers.spread(std::vector<Vec3>{Vec3(1, -1, 2)}, f);

  std::vector<Vec3> of_force(1), elsewhere(1), forced(1);
  markers.interpolate(f, of_force);
  // The same weights twice: (sum phi^2)^3 / dx^3.
  const double expected = std::pow(32.0 * sum_phi_squared(GetParam()), 3);
  EXPECT_LT((of_force[0] - expected * Vec3(1, -1, 2)).norm(), 4.0 * float_epsilon * expected);
  markers_at(forest, far).interpolate(f, elsewhere);
  EXPECT_EQ(elsewhere[0], Vec3::Zero());

  const fluid::VelocityView view = fluid.view();
  const fluid::FineStep step{0.0, 0.1, view, f, 0.1};
  markers.interpolate(step, forced);
  EXPECT_LT((forced[0] - Vec3(1, 2, 3) - 0.1 * of_force[0]).norm(), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Delta, MarkersOfBothDeltas, ::testing::Values(Delta::peskin4, Delta::peskin3),
                         [](const auto& test) { return test.param == Delta::peskin4 ? "peskin4" : "peskin3"; });

std::string message_for(const amr::Forest& forest, const Vec3& place) {
  Markers markers(forest, Delta::peskin4, "canopy");
  try {
    markers.move_to(std::vector<Vec3>{Vec3::Zero(), Vec3(0.1, 0.1, 0.1), place});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(MarkersAtTheEdge, a_marker_that_reaches_coarser_blocks_is_named) {
  const amr::Forest forest = cube_of_fine_blocks();
  EXPECT_EQ(message_for(forest, Vec3(1.0 - 1.51 / 32, 0, 0)), "");
  const std::string expected =
      "body 'canopy': marker 2 at (0.96875, 0, 0.25) m must lie in cells of the finest level 1 (0.03125 m) with a "
      "margin of "
      "0.0625 m, but reaches cells of level 0 (0.0625 m); enlarge the refined region so that it holds the body "
      "wherever it "
      "moves";
  EXPECT_EQ(message_for(forest, Vec3(1.0 - 1.0 / 32, 0, 0.25)), expected);
  EXPECT_NE(message_for(forest, Vec3(1.7, 0, 0.25)).find("reaches cells of level 0"), std::string::npos);
  EXPECT_NE(message_for(forest, Vec3(-1.0, 0, 0.25)).find("reaches cells of level 0"), std::string::npos);
}

TEST(MarkersAtTheEdge, a_marker_that_reaches_out_of_the_domain_is_named) {
  const amr::Forest forest = cube_of_fine_blocks();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& place :
       {Vec3(0, 1, 0), Vec3(0, 0, -1), Vec3(0, 1 - 1.49 / 32, 0), Vec3(5, 0, 0), Vec3(0, 1e30, 0), Vec3(0, nan, 0)}) {
    const std::string message = message_for(forest, place);
    EXPECT_NE(message.find("marker 2 at"), std::string::npos) << place.transpose();
    EXPECT_NE(message.find("reaches out of the domain"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace drogue::ib
