// SPDX-License-Identifier: GPL-3.0-or-later
// Lattice-Boltzmann fluid on a block forest: weakly compressible Navier-Stokes, acoustic scaling (the time step halves
// with the cell), levels sub-cycled. One coarse step of level l is
//   fill what lies beyond the domain; stream and collide the leaves, from the field at t to the field at t + dt;
//   twice: interpolate the rims of level l + 1 in space and time, advance it, restrict it onto the parents of l.
// On the finest level the hook sees the velocity after each step and returns a force, u += kappa f.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "fluid/fluid_solver.hpp"
#include "fluid/specification.hpp"
#include "lbm/boundary.hpp"
#include "lbm/level_transfer.hpp"
#include "lbm/stream_collide.hpp"

namespace drogue::lbm {

/// S is the storage of the non-equilibrium stress: HalfStress or FloatStress.
template <class S>
class BasicSolver : public fluid::FluidSolver {
 public:
  BasicSolver(amr::Forest forest, fluid::Specification specification);
  BasicSolver(const BasicSolver&) = delete;
  BasicSolver& operator=(const BasicSolver&) = delete;

  void step(fluid::FineStepHook* hook) override;

  const amr::Forest& forest() const override { return forest_; }
  double time() const override { return levels_.front().time; }
  double coarse_dt() const override { return levels_.front().dt; }
  double fine_dt() const override { return levels_.back().dt; }
  const fluid::FluidStatistics& statistics() const override { return statistics_; }
  fluid::VelocityView fine_velocity() const override { return velocity_view(levels_.back().now); }
  void read_block(int block, fluid::BlockFields& fields) const override;
  std::array<double, 4> mass_and_momentum() const override;

  /// Relaxation time of a level in its own steps.
  double tau(int level) const { return levels_[level].relaxation.tau; }

 private:
  struct SpongeCell {
    int block;
    Index3 cell;
    float damping;              // share of the deviation taken per step
    std::array<float, 4> rest;  // drho and u that it damps towards
  };
  struct Level {
    double dt;          // [s]
    double time = 0.0;  // [s] of the field `now`
    int now = 0;        // which of the two fields holds the level's present
    Relaxation relaxation;
    TransferPlan from_coarser, to_parents;
    std::vector<SpongeCell> sponge;
  };

  void initialise();
  void initialise_block(int block, const fluid::Specification& specification);
  void build_sponge(int level);
  void advance(int level, fluid::FineStepHook* hook);
  void stream_and_collide(int level);
  void interpolate_rims(int level, bool midway);
  void restrict_to_parents(int level, int field);
  void apply_sponge(int level);
  void couple(fluid::FineStepHook& hook);
  [[noreturn]] void report_divergence(int level) const;
  fluid::VelocityView velocity_view(int field) const;
  float stress_ratio(int from, int to) const;

  amr::Forest forest_;
  fluid::Specification specification_;
  Units units_;
  std::vector<Level> levels_;
  std::array<MomentField<S>, 2> field_;
  BoundaryFill<S> fill_boundary_;
  fluid::ForceField force_;
  std::array<std::vector<const float*>, 2> velocity_base_;  // per field and block, for the views
  fluid::FluidStatistics statistics_;
};

using Solver = BasicSolver<DefaultStress>;

}  // namespace drogue::lbm
