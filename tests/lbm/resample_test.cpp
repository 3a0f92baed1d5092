// SPDX-License-Identifier: GPL-3.0-or-later
// The transfer between levels reproduces cubic fields, wherever the interface has faces, edges, concave and convex
// corners.
#include <gtest/gtest.h>

#include <cmath>

#include "lbm/level_transfer.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

double cubic(const Vec3& x) {
  return 0.3 + x[0] - 2.0 * x[1] + x[0] * x[1] * x[2] + x[0] * x[0] * x[0] - x[1] * x[1] * x[2] +
         0.5 * x[2] * x[2] * x[2];
}

/// Coarse box of 3 x 3 x 3 blocks with an L-shaped refined region: concave and convex edges and corners.
amr::Forest l_shaped() {
  const double dx = 1.0 / 48;
  const Box a{Vec3::Constant(0.34), Vec3(0.65, 0.65, 0.65)}, b{Vec3(0.34, 0.67, 0.34), Vec3(0.49, 0.9, 0.65)};
  return amr::Forest({{Vec3::Zero(), Vec3::Ones()}, dx, {}}, 1,
                     amr::any_of({amr::refine_box(a, dx, dx / 2), amr::refine_box(b, dx, dx / 2)}));
}

using Field = MomentField<FloatStress>;

void fill(const amr::Forest& forest, Field& field, amr::Kind kind) {
  for (int level = 0; level < forest.levels(); ++level) {
    const auto range = forest.range(level, kind);
    for (int id = range.begin; id < range.end; ++id)
      for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
          for (int x = 0; x < n; ++x)
            for (int m = 0; m < moments; ++m)
              RowLayout<FloatStress>::put(field.row(id, y, z), m, x,
                                          static_cast<float>((m + 1) * cubic(forest.cell_centre(id, {x, y, z}))));
  }
}

/// Largest error over the boxes of a plan, each moment over its own size.
double largest_error(const amr::Forest& forest, const TransferPlan& plan, const Field& field, float stress_factor) {
  double largest = 0.0;
  for (const ResampleJob& job : plan.job)
    for (int z = job.axis[2].begin; z < job.axis[2].end; ++z)
      for (int y = job.axis[1].begin; y < job.axis[1].end; ++y)
        for (int x = job.axis[0].begin; x < job.axis[0].end; ++x)
          for (int m = 0; m < moments; ++m) {
            const Index3 cell{x + job.shift[0], y + job.shift[1], z + job.shift[2]};
            const double expected = cubic(forest.cell_centre(job.target, cell)) * (m < 4 ? 1.0 : stress_factor);
            const float value = RowLayout<FloatStress>::get(field.row(job.target, cell[1], cell[2]), m, cell[0]);
            largest = std::max(largest, std::abs(value / (m + 1) - expected));
          }
  return largest;
}

TEST(LevelTransfer, restriction_and_interpolation_reproduce_cubic_fields) {
  const amr::Forest forest = l_shaped();
  Field field(forest.size());
  fill(forest, field, amr::Kind::leaf);
  const TransferPlan up = plan_restriction(forest, 0), down = plan_interpolation(forest, 1);
  ASSERT_FALSE(up.job.empty());
  ASSERT_FALSE(down.job.empty());
  const SourceFields<FloatStress> now{field, nullptr, field};
  for (const ResampleJob& job : up.job) resample(job, forest, now, {1.0}, field);
  EXPECT_LT(largest_error(forest, up, field, 1.0f), 2e-6);
  for (const ResampleJob& job : down.job) resample(job, forest, now, {1.5}, field);
  EXPECT_LT(largest_error(forest, down, field, 1.5f), 4e-6);
}

TEST(LevelTransfer, every_rim_a_leaf_streams_from_is_filled) {
  const amr::Forest forest = l_shaped();
  Field field(forest.size());
  for (const amr::Kind kind : {amr::Kind::leaf, amr::Kind::parent, amr::Kind::ghost}) fill(forest, field, kind);
  // what a plan does not fill keeps a mark
  for (const amr::Kind kind : {amr::Kind::parent, amr::Kind::ghost})
    for (int level = 0; level < forest.levels(); ++level) {
      const auto range = forest.range(level, kind);
      for (int id = range.begin; id < range.end; ++id)
        for (int r = 0; r < rows_per_block; ++r)
          for (int x = 0; x < n; ++x)
            RowLayout<FloatStress>::put(field.block(id) + r * RowLayout<FloatStress>::bytes, drho, x, 1e6f);
    }
  const SourceFields<FloatStress> now{field, nullptr, field};
  for (const ResampleJob& job : plan_restriction(forest, 0).job) resample(job, forest, now, {1.0}, field);
  for (const ResampleJob& job : plan_interpolation(forest, 1).job) resample(job, forest, now, {1.0}, field);
  for (int level = 0; level < forest.levels(); ++level) {
    const auto leaves = forest.range(level, amr::Kind::leaf);
    for (int id = leaves.begin; id < leaves.end; ++id)
      for (int slot = 0; slot < 27; ++slot) {
        const Index3 o = amr::slot_offset(slot);
        if (std::abs(o[0]) + std::abs(o[1]) + std::abs(o[2]) > 2) continue;  // no population crosses a corner
        const int neighbour = forest.block(id).neighbour[slot];
        if (forest.block(neighbour).kind == amr::Kind::boundary) continue;
        for (int c = 0; c < amr::block_cells; ++c) {
          const Index3 cell = amr::cell_at(c);
          bool at_rim = true;
          for (int a = 0; a < 3; ++a) at_rim &= o[a] == 0 || cell[a] == (o[a] > 0 ? 0 : n - 1);
          if (!at_rim) continue;
          ASSERT_LT(RowLayout<FloatStress>::get(field.row(neighbour, cell[1], cell[2]), drho, cell[0]), 100.0f);
        }
      }
  }
}

TEST(LevelTransfer, weights_sum_to_one_and_remove_the_shortest_wave_on_the_way_up) {
  const Axis axis = restriction_axis(0, n / 2);
  for (int i = 0; i < n / 2; ++i) {
    double sum = 0.0, alternating = 0.0;
    for (int k = 0; k < axis.taps; ++k) {
      sum += axis.weight[i][k];
      alternating += (k & 1 ? -1.0 : 1.0) * axis.weight[i][k];
    }
    EXPECT_DOUBLE_EQ(sum, 1.0);
    EXPECT_DOUBLE_EQ(alternating, 0.0);
  }
}

}  // namespace
}  // namespace drogue::lbm
