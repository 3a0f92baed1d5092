// SPDX-License-Identifier: GPL-3.0-or-later
#include "fluid/averages.hpp"

#include <cmath>
#include <memory>
#include <vector>

namespace drogue::fluid {

namespace {

constexpr int n = amr::block_size;

/// Volume average of N numbers a cell. Each thread calls `make_sum()` for a function that adds them up over a block.
template <int N, class MakeSum>
std::array<double, N> average(const FluidSolver& fluid, MakeSum make_sum) {
  const amr::Forest& forest = fluid.forest();
  std::array<double, N> total{};
  double volume = 0.0;
  for (int level = 0; level < forest.levels(); ++level) {
    const auto leaves = forest.range(level, amr::Kind::leaf);
    std::vector<std::array<double, N>> part(leaves.size());
#pragma omp parallel
    {
      auto sum = make_sum();
#pragma omp for schedule(static)
      for (int id = leaves.begin; id < leaves.end; ++id) part[id - leaves.begin] = sum(id);
    }
    const double cell_volume = std::pow(forest.spacing(level), 3);
    volume += cell_volume * static_cast<double>(forest.cells(level));
    for (const auto& p : part) {
      for (int i = 0; i < N; ++i) total[i] += cell_volume * p[i];
    }
  }
  for (double& t : total) t /= volume;
  return total;
}

/// The velocity of a leaf and of two layers of cells beyond each of its faces.
class PaddedVelocity {
 public:
  explicit PaddedVelocity(const FluidSolver& fluid) : fluid_(&fluid), fields_(std::make_unique<BlockFields>()) {
    for (auto& component : u_) component.resize(m * m * m);
  }

  void read(int leaf) {
    fluid_->read_block(leaf, *fields_);
    for (int cell = 0; cell < amr::block_cells; ++cell) copy(cell, amr::cell_at(cell));
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {-1, 1}) {
        if (!copy_neighbour(leaf, axis, side)) extrapolate(axis, side);
      }
    }
  }
  /// Derivative of component `a` along `axis` at a cell, per cell.
  double derivative(int a, int axis, const Index3& cell) const {
    const double* u = &u_[a][index(cell)];
    const int s = stride(axis);
    return (8.0 * (u[s] - u[-s]) - (u[2 * s] - u[-2 * s])) / 12.0;
  }

 private:
  static constexpr int pad = 2, m = n + 2 * pad;

  static int stride(int axis) { return axis == 0 ? 1 : axis == 1 ? m : m * m; }
  static int index(const Index3& c) { return ((c[2] + pad) * m + c[1] + pad) * m + c[0] + pad; }
  void copy(int from, const Index3& to) {
    for (int a = 0; a < 3; ++a) u_[a][index(to)] = fields_->velocity[a][from];
  }
  /// False if there is none on this level.
  bool copy_neighbour(int leaf, int axis, int side) {
    Index3 offset{};
    offset[axis] = side;
    const auto& forest = fluid_->forest();
    const int id = forest.block(leaf).neighbour[amr::neighbour_slot(offset[0], offset[1], offset[2])];
    if (forest.block(id).kind != amr::Kind::leaf && forest.block(id).kind != amr::Kind::parent) return false;
    fluid_->read_block(id, *fields_);
    for (int cell = 0; cell < amr::block_cells; ++cell) {
      Index3 to = amr::cell_at(cell);
      to[axis] += side * n;
      if (to[axis] >= -pad && to[axis] < n + pad) copy(cell, to);
    }
    return true;
  }
  /// Goes on with the cubic through the four outermost cells, which makes the differences one-sided.
  void extrapolate(int axis, int side) {
    const int inwards = -side * stride(axis);
    for (int line = 0; line < n * n; ++line) {
      Index3 outermost;
      outermost[axis] = side > 0 ? n - 1 : 0;
      outermost[(axis + 1) % 3] = line % n;
      outermost[(axis + 2) % 3] = line / n;
      for (auto& component : u_) {
        double* u = &component[index(outermost)];
        for (int layer = 0; layer < pad; ++layer, u -= inwards) {
          u[-inwards] = 4.0 * u[0] - 6.0 * u[inwards] + 4.0 * u[2 * inwards] - u[3 * inwards];
        }
      }
    }
  }

  const FluidSolver* fluid_;
  std::unique_ptr<BlockFields> fields_;
  std::array<std::vector<double>, 3> u_;  // [z][y][x]
};

}  // namespace

double kinetic_energy(const FluidSolver& fluid) {
  const auto make_sum = [&] {
    return [&fluid, fields = std::make_unique<BlockFields>()](int id) {
      fluid.read_block(id, *fields);
      double sum = 0.0;
      for (const auto& component : fields->velocity) {
        for (const double u : component) sum += 0.5 * u * u;
      }
      return std::array{sum};
    };
  };
  return average<1>(fluid, make_sum)[0];
}

double enstrophy(const FluidSolver& fluid) {
  const auto make_sum = [&] {
    return [&forest = fluid.forest(), u = PaddedVelocity(fluid)](int id) mutable {
      u.read(id);
      double sum = 0.0;
      for (int cell = 0; cell < amr::block_cells; ++cell) {
        const Index3 at = amr::cell_at(cell);
        for (int a = 0; a < 3; ++a) {
          const int b = (a + 1) % 3, c = (a + 2) % 3;
          sum += 0.5 * std::pow(u.derivative(c, b, at) - u.derivative(b, c, at), 2);
        }
      }
      return std::array{sum / std::pow(forest.spacing(forest.block(id).level), 2)};
    };
  };
  return average<1>(fluid, make_sum)[0];
}

double relative_velocity_error(const FluidSolver& fluid, const std::array<Expression, 3>& velocity) {
  const auto make_sum = [&] {
    return [&fluid, exact = velocity, fields = std::make_unique<BlockFields>()](int id) {
      fluid.read_block(id, *fields);
      std::array<double, 2> sum{};
      for (int cell = 0; cell < amr::block_cells; ++cell) {
        const Vec3 place = fluid.forest().cell_centre(id, amr::cell_at(cell));
        for (int a = 0; a < 3; ++a) {
          const double v = exact[a](place, fluid.time());
          sum[0] += std::pow(fields->velocity[a][cell] - v, 2);
          sum[1] += v * v;
        }
      }
      return sum;
    };
  };
  const auto [difference, size] = average<2>(fluid, make_sum);
  return std::sqrt(difference / size);
}

}  // namespace drogue::fluid
