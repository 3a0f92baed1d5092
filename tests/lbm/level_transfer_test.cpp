// SPDX-License-Identifier: GPL-3.0-or-later
// The transfer between levels reproduces cubic fields, wherever the interface has faces, edges, concave and convex
// corners, and converts what levels differ by in the stress.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "lbm/level_transfer.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

double cubic(const Vec3& x) {
  return 0.3 + x[0] - 2.0 * x[1] + x[0] * x[1] * x[2] + x[0] * x[0] * x[0] - x[1] * x[1] * x[2] +
         0.5 * x[2] * x[2] * x[2];
}

/// What a level makes of the stress: this multiple of it, with a share of its curvature [m^2] on top.
struct Stress {
  double factor = 1.0, share = 0.0;
};
using Stresses = std::array<Stress, 2>;

/// Moment m, a cubic field, on a level.
double value(int m, const Vec3& x, const Stress& stress) {
  if (m < pxx) return (m + 1) * cubic(x);
  const Vec3 curvature{6.0 * x[0], -2.0 * x[2], 3.0 * x[2]};
  double v = cubic(x);
  for (int axis = 0; axis < 3; ++axis) v += is_curved(m, axis) ? stress.share * curvature[axis] : 0.0;
  return (m + 1) * stress.factor * v;
}

/// Coarse box of 3 x 3 x 3 blocks with an L-shaped refined region: concave and convex edges and corners.
amr::Forest l_shaped() {
  const double dx = 1.0 / 48;
  const Box a{Vec3::Constant(0.34), Vec3(0.65, 0.65, 0.65)}, b{Vec3(0.34, 0.67, 0.34), Vec3(0.49, 0.9, 0.65)};
  return amr::Forest({{Vec3::Zero(), Vec3::Ones()}, dx, {}}, 1,
                     amr::any_of({amr::refine_box(a, dx, dx / 2), amr::refine_box(b, dx, dx / 2)}));
}

using Field = MomentField<FloatStress>;

void fill(const amr::Forest& forest, Field& field, amr::Kind kind, const Stresses& stress = {}) {
  for (int level = 0; level < forest.levels(); ++level) {
    const auto range = forest.range(level, kind);
    for (int id = range.begin; id < range.end; ++id)
      for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
          for (int x = 0; x < n; ++x)
            for (int m = 0; m < moments; ++m)
              RowLayout<FloatStress>::put(
                  field.row(id, y, z), m, x,
                  static_cast<float>(value(m, forest.cell_centre(id, {x, y, z}), stress[level])));
    for (int id = range.begin; id < range.end; ++id) field.refresh_columns(id);
  }
}

/// Fills the rims of the coarser level, then those of the finer one.
void transfer(const amr::Forest& forest, Field& field, const Stresses& stress = {}) {
  const double curvature = stress[1].share - stress[0].share, ratio = stress[1].factor / stress[0].factor;
  const double coarse = forest.spacing(0), fine = forest.spacing(1);
  const RestrictionPlan plan = plan_restriction(forest, 1);
  const auto restriction = std::make_unique<Restriction<FloatStress>>(forest, -curvature / (fine * fine));
  const auto leaves = forest.range(1, amr::Kind::leaf);
  const auto sums = std::make_unique<LayerSums<FloatStress>>();
  for (int leaf = leaves.begin; leaf < leaves.end; ++leaf) {
    sums->begin();
    restriction->request(plan[leaf], *sums);
    sums->sum(field.block(leaf));
    restriction->write(leaf, plan[leaf], {1.0 / ratio}, field);
  }
  Interpolation<FloatStress> interpolation(forest, 1, curvature / (coarse * coarse));
  interpolation.start(field);
  interpolation.fill_rims({ratio}, field);
}

/// A moment of a neighbour at `offset`, as the update of a block finds it: in columns across x faces, else in rows.
float value_at(const amr::Forest& forest, const Field& field, int id, const Index3& offset, const Index3& cell, int m) {
  using Layout = RowLayout<FloatStress>;
  const int along = offset[1] != 0 ? 2 : 1;
  Index3 first = cell;
  first[along] = 0;
  if (offset[0] != 0 && is_in_columns(forest, id, first, along))
    return Layout::get(field.column(id, cell[0], cell[2]), m, cell[1]);
  return Layout::get(field.row(id, cell[1], cell[2]), m, cell[0]);
}

/// Calls f(neighbour, offset, cell) for all cells of the ghosts and parents around the leaves of `level` that a leaf
/// streams from.
template <class F>
void for_each_rim_cell(const amr::Forest& forest, int level, const F& f) {
  const auto leaves = forest.range(level, amr::Kind::leaf);
  for (int id = leaves.begin; id < leaves.end; ++id)
    for (int slot = 0; slot < 27; ++slot) {
      const Index3 o = amr::slot_offset(slot);
      if (std::abs(o[0]) + std::abs(o[1]) + std::abs(o[2]) > 2) continue;  // no population crosses a corner
      const int neighbour = forest.block(id).neighbour[slot];
      const amr::Kind kind = forest.block(neighbour).kind;
      if (kind != amr::Kind::ghost && kind != amr::Kind::parent) continue;
      for (int c = 0; c < amr::block_cells; ++c) {
        const Index3 cell = amr::cell_at(c);
        bool at_rim = true;
        for (int a = 0; a < 3; ++a) at_rim &= o[a] == 0 || cell[a] == (o[a] > 0 ? 0 : n - 1);
        if (at_rim) f(neighbour, o, cell);
      }
    }
}

TEST(LevelTransfer, every_rim_a_leaf_streams_from_reproduces_cubic_fields) {
  const amr::Forest forest = l_shaped();
  Field field(forest.size());
  for (const Stresses& stress : {Stresses{}, Stresses{Stress{1.0, -4e-5}, Stress{0.75, 1e-5}}}) {
    fill(forest, field, amr::Kind::leaf, stress);
    transfer(forest, field, stress);
    for (const int level : {0, 1}) {
      double largest = 0.0;  // each moment over its own size
      for_each_rim_cell(forest, level, [&](int id, const Index3& offset, const Index3& cell) {
        for (int m = 0; m < moments; ++m) {
          const double expected = value(m, forest.cell_centre(id, cell), stress[level]);
          largest = std::max(largest, std::abs(value_at(forest, field, id, offset, cell, m) - expected) / (m + 1));
        }
      });
      EXPECT_LT(largest, level == 0 ? 2e-6 : 4e-6);
    }
  }
}

TEST(LevelTransfer, boundary_blocks_find_the_rims_they_mirror_in_rows) {
  // refined up to the upper y face of the domain
  const double dx = 1.0 / 48;
  const amr::Forest forest({{Vec3::Zero(), Vec3::Ones()}, dx, {}}, 1,
                           amr::refine_box({Vec3(0.34, 0.34, 0.34), Vec3(0.65, 1.0, 0.65)}, dx, dx / 2));
  Field field(forest.size());
  fill(forest, field, amr::Kind::leaf);
  transfer(forest, field);
  for (const int level : {0, 1})
    for_each_rim_cell(forest, level, [&](int id, const Index3& offset, const Index3& cell) {
      if (offset[1] != 0 || offset[2] != 0 || cell[1] != n - 1) return;
      const int above = forest.block(id).neighbour[amr::neighbour_slot(0, 1, 0)];
      if (forest.block(above).kind != amr::Kind::boundary) return;
      for (int m = 0; m < moments; ++m)
        ASSERT_NEAR(value_at(forest, field, id, {0, 1, 0}, cell, m), (m + 1) * cubic(forest.cell_centre(id, cell)),
                    4e-6 * (m + 1));
    });
}

TEST(LevelTransfer, weights_sum_up_and_remove_the_shortest_wave_on_the_way_up) {
  const Axis axis = restriction_axis();
  for (int i = 0; i < n; ++i) {
    for (const bool curvature : {false, true}) {
      double sum = 0.0, alternating = 0.0;
      for (int k = 0; k < axis.taps; ++k) {
        const double weight = curvature ? axis.curvature[i][k] : axis.weight[i][k];
        sum += weight;
        alternating += (k & 1 ? -1.0 : 1.0) * weight;
      }
      EXPECT_DOUBLE_EQ(sum, curvature ? 0.0 : 1.0);
      EXPECT_DOUBLE_EQ(alternating, 0.0);
    }
  }
}

}  // namespace
}  // namespace drogue::lbm
