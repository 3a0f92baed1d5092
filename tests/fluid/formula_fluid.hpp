// SPDX-License-Identifier: GPL-3.0-or-later
// A fluid that does not move on: its fields are formulas, averaged in parents.
#pragma once

#include <memory>
#include <stdexcept>
#include <utility>

#include "core/expression.hpp"
#include "fluid/fluid_solver.hpp"

namespace drogue::testing {

class FormulaFluid : public fluid::FluidSolver {
 public:
  FormulaFluid(amr::Forest forest, std::array<Expression, 3> velocity, Expression pressure = 0.0)
      : forest_(std::move(forest)), velocity_(std::move(velocity)), pressure_(std::move(pressure)) {}

  void read_block(int block, fluid::BlockFields& fields) const override {
    const auto expression = velocity_;  // threads evaluate copies
    for (int cell = 0; cell < amr::block_cells; ++cell) {
      for (int a = 0; a < 3; ++a) fields.velocity[a][cell] = mean(expression[a], block, amr::cell_at(cell));
      fields.pressure[cell] = mean(Expression(pressure_), block, amr::cell_at(cell));
    }
  }
  const amr::Forest& forest() const override { return forest_; }
  double time() const override { return 1.5; }

  void step(fluid::FineStepHook*) override {}
  double coarse_dt() const override { return 1.0; }
  double fine_dt() const override { return 1.0; }
  const fluid::FluidStatistics& statistics() const override { return statistics_; }
  fluid::VelocityView fine_velocity() const override { throw std::logic_error("it has none"); }
  std::array<double, 4> mass_and_momentum() const override { return {}; }
  void transfer_state(Archive&) override {}

 private:
  /// Of a parent the mean over eight parts of the cell, as its children would have it.
  float mean(const Expression& e, int block, const Index3& cell) const {
    const Vec3 centre = forest_.cell_centre(block, cell);
    if (forest_.block(block).kind == amr::Kind::leaf) return static_cast<float>(e(centre, time()));
    const double quarter = 0.25 * forest_.spacing(forest_.block(block).level);
    double sum = 0.0;
    for (int i = 0; i < 8; ++i) {
      sum += e(centre + quarter * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1), time());
    }
    return static_cast<float>(sum / 8.0);
  }

  amr::Forest forest_;
  std::array<Expression, 3> velocity_;
  Expression pressure_;
  fluid::FluidStatistics statistics_;
};

/// The unit cube in cells of 1 / `across`; the part x, y < 1/2 is refined once if `refined`.
inline amr::Forest unit_cube(int across, bool periodic, bool refined = false) {
  const amr::Domain domain{{Vec3::Zero(), Vec3::Ones()}, 1.0 / across, {periodic, periodic, periodic}};
  const Box quarter{Vec3(0.01, 0.01, 0.0), Vec3(0.49, 0.49, 1.0)};
  return amr::Forest(domain, refined ? 1 : 0, amr::refine_box(quarter, domain.coarsest, 0.5 / across));
}

}  // namespace drogue::testing
