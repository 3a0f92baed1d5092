// SPDX-License-Identifier: GPL-3.0-or-later
#include "fluid/deviation.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace drogue::fluid {

namespace {

/// Largest `magnitude(fields, cell)` in the box.
template <class Magnitude>
double largest(const FluidSolver& fluid, const Box& box, Magnitude magnitude) {
  const amr::Forest& forest = fluid.forest();
  const auto fields = std::make_unique<BlockFields>();
  double result = 0.0;
  for (int level = 0; level < forest.levels(); ++level) {
    const auto leaves = forest.range(level, amr::Kind::leaf);
    for (int id = leaves.begin; id < leaves.end; ++id) {
      if (!box.overlaps(forest.box(id))) continue;
      fluid.read_block(id, *fields);
      for (int cell = 0; cell < amr::block_cells; ++cell) {
        if (box.contains(forest.cell_centre(id, amr::cell_at(cell))))
          result = std::max(result, magnitude(*fields, cell));
      }
    }
  }
  return result;
}

}  // namespace

double largest_velocity_deviation(const FluidSolver& fluid, const Box& box, const Vec3& velocity) {
  return largest(fluid, box, [&](const BlockFields& fields, int cell) {
    const auto& [u, v, w] = fields.velocity;
    return (Vec3(u[cell], v[cell], w[cell]) - velocity).norm();
  });
}

double largest_pressure(const FluidSolver& fluid, const Box& box) {
  return largest(fluid, box,
                 [](const BlockFields& fields, int cell) { return std::abs(double{fields.pressure[cell]}); });
}

}  // namespace drogue::fluid
