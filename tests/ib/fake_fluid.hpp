// SPDX-License-Identifier: GPL-3.0-or-later
// A fluid without dynamics: velocities of the finest level in plain arrays, changed by forces alone (u += kappa f).
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include "amr/forest.hpp"
#include "fluid/fluid_solver.hpp"

namespace drogue::testing {

class FakeFluid {
 public:
  explicit FakeFluid(const amr::Forest& forest, double density = 1.0)
      : forest_(&forest),
        density_(density),
        leaves_(forest.range(forest.finest(), amr::Kind::leaf)),
        values_(static_cast<std::size_t>(leaves_.size()) * block_floats),
        base_(forest.size(), nullptr),
        f_(forest) {
    for (int id = leaves_.begin; id < leaves_.end; ++id) base_[id] = values_.data() + first(id);
  }

  double density() const { return density_; }
  double spacing() const { return forest_->spacing(forest_->finest()); }
  double cell_volume() const { return spacing() * spacing() * spacing(); }
  fluid::VelocityView view() const { return {forest_, base_.data(), amr::block_size, stride_y, stride_z, scale}; }
  const fluid::ForceField& force() const { return f_; }

  /// Calls visit(position, value(component)) for every cell of the finest leaves; value returns a float&.
  template <class Visit>
  void each_cell(const Visit& visit) {
    for (int id = leaves_.begin; id < leaves_.end; ++id) {
      for (int k = 0; k < amr::block_size; ++k) {
        for (int j = 0; j < amr::block_size; ++j) {
          for (int i = 0; i < amr::block_size; ++i) {
            float* cell = values_.data() + first(id) + k * stride_z + j * stride_y + i;
            visit(forest_->cell_centre(id, {i, j, k}), [cell](int a) -> float& { return cell[a * amr::block_size]; });
          }
        }
      }
    }
  }

  /// Sets the velocity [m/s] to a function of the position.
  template <class Velocity>
  void fill(const Velocity& velocity) {
    each_cell([&](const Vec3& x, auto value) {
      const Vec3 u = velocity(x);
      for (int a = 0; a < 3; ++a) value(a) = static_cast<float>(u[a]) / scale;
    });
  }

  void fill_at_random(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    fill([&](const Vec3&) { return Vec3(unit(random), unit(random), unit(random)); });
  }

  /// Calls the hook, then applies the force it left; velocities are then multiplied by `decay`.
  void step(fluid::FineStepHook& hook, double dt, double decay = 1.0) {
    f_.clear();
    time_ += dt;
    const fluid::VelocityView u = view();
    const double kappa = dt / density_;
    fluid::FineStep fine{time_, dt, u, f_, kappa};
    hook.on_fine_step(fine);
    for (int id : f_.opened()) {
      const float* f = f_.block(id);
      for (int row = 0; row < amr::block_size * amr::block_size; ++row) {
        float* to = values_.data() + first(id) + row / amr::block_size * stride_z + row % amr::block_size * stride_y;
        for (int i = 0; i < fluid::ForceField::stride_y; ++i) {
          to[i] += static_cast<float>(kappa / scale * f[row * fluid::ForceField::stride_y + i]);
        }
      }
    }
    if (decay != 1.0) {
      for (float& value : values_) value *= static_cast<float>(decay);
    }
  }

  /// Of the finest leaves [kg m/s].
  Vec3 momentum() {
    Vec3 sum = Vec3::Zero();
    each_cell([&](const Vec3&, auto value) { sum += Vec3(value(0), value(1), value(2)); });
    return sum * double{scale} * density_ * cell_volume();
  }

  double max_speed() {
    double largest = 0.0;
    each_cell([&](const Vec3&, auto value) { largest = std::max(largest, Vec3(value(0), value(1), value(2)).norm()); });
    return largest * double{scale};
  }

 private:
  // Rows are longer than three components and the unit is not 1 m/s, as in a lattice Boltzmann fluid.
  static constexpr int stride_y = 5 * amr::block_size, stride_z = stride_y * amr::block_size;
  static constexpr int block_floats = stride_z * amr::block_size;
  static constexpr float scale = 4.0f;

  std::size_t first(int id) const { return static_cast<std::size_t>(id - leaves_.begin) * block_floats; }

  const amr::Forest* forest_;
  double density_;
  amr::BlockRange leaves_;
  std::vector<float> values_;
  std::vector<const float*> base_;
  fluid::ForceField f_;
  double time_ = 0.0;
};

/// Calls visit(position, force per volume) for every cell of the opened blocks.
template <class Visit>
void each_forced_cell(const amr::Forest& forest, const fluid::ForceField& f, const Visit& visit) {
  using F = fluid::ForceField;
  for (int id : f.opened()) {
    const float* base = f.block(id);
    for (int k = 0; k < amr::block_size; ++k) {
      for (int j = 0; j < amr::block_size; ++j) {
        for (int i = 0; i < amr::block_size; ++i) {
          const float* cell = base + k * F::stride_z + j * F::stride_y + i;
          visit(forest.cell_centre(id, {i, j, k}),
                Vec3(cell[0], cell[F::stride_component], cell[2 * F::stride_component]));
        }
      }
    }
  }
}

/// Two levels; the finer one, 4^3 blocks of cells of 1/32 m, is the cube from -1 to 1 m. It ends at the domain's
/// boundaries along y and z, and in coarser blocks along x.
inline amr::Forest cube_of_fine_blocks() {
  const amr::Domain domain{{Vec3(-2, -1, -1), Vec3(2, 1, 1)}, 1.0 / 16};
  return {domain, 1, amr::refine_box({Vec3(-1, -1, -1), Vec3(1, 1, 1)}, domain.coarsest, 1.0 / 32)};
}

/// One level of 2 x 1 x 1 blocks of cells of 1/16 m, periodic along every axis.
inline amr::Forest periodic_box() {
  return {{{Vec3(0, 0, 0), Vec3(2, 1, 1)}, 1.0 / 16, {true, true, true}}, 0, [](const Box&, int) { return false; }};
}

}  // namespace drogue::testing
