// SPDX-License-Identifier: GPL-3.0-or-later
// Lattice-Boltzmann fluid on a block forest: weakly compressible Navier-Stokes, acoustic scaling (the time step halves
// with the cell), levels sub-cycled. One coarse step of level l is
//   fill what lies beyond the domain; stream and collide the leaves, from the field at t to the field at t + dt, which
//   also restricts them onto the parents of l - 1;
//   twice: interpolate the rims of level l + 1 in space and time, advance it.
// On the finest level the hook sees the velocity after each step and returns a force, u += kappa f.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "fluid/fluid_solver.hpp"
#include "fluid/specification.hpp"
#include "lbm/boundary.hpp"
#include "lbm/fine_velocity.hpp"
#include "lbm/interpolation.hpp"
#include "lbm/reflux.hpp"
#include "lbm/restriction.hpp"
#include "lbm/stream_collide.hpp"

namespace drogue::lbm {

/// S is the storage of the state: HalfStress, FloatStress or DoubleStress.
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
  fluid::VelocityView fine_velocity() const override;
  void read_block(int block, fluid::BlockFields& fields) const override;
  std::array<double, 4> mass_and_momentum() const override;
  void transfer_state(Archive& archive) override;

  /// Relaxation time of a level in its own steps.
  double tau(int level) const { return levels_[level].relaxation.tau; }

 private:
  using Real = typename S::Real;
  struct SpongeCell {
    Index3 cell;
    Real damping;              // share of the deviation taken per step
    std::array<Real, 4> rest;  // drho and u that it damps towards
  };
  struct SpongeBlock {
    int block;
    std::vector<SpongeCell> cells;
  };
  struct Level {
    double dt;                 // [s]
    double time = 0.0;         // [s] of the field `now`
    int now = 0;               // which of the two fields holds the level's present
    bool completes = false;    // the step at hand: one of the coarser level
    Vec3 lead = Vec3::Zero();  // of the stored velocity before that of the fluid, cells per step: lbm/body_force.cpp
    Relaxation relaxation;
    std::optional<RestrictionPlan> to_parents;  // of the next coarser level, if there is one
    std::vector<SpongeBlock> sponge;
  };

  void initialise();
  void initialise_block(int block, const fluid::Specification& specification);
  void build_sponge(int level);
  void advance(int level, fluid::FineStepHook* hook);
  void stream_and_collide(int level);
  void advance_twice(int level, fluid::FineStepHook* hook);
  void restrict_changed(int level, MomentField<S>& coarse);
  void join_levels();
  Vec3 half_kick(int level, double time) const;
  void set_kick(int level, double time);
  void apply_sponge(int level);
  void couple(fluid::FineStepHook& hook);
  [[noreturn]] void report_divergence(int level) const;
  BlockNeighbourhood<S> neighbourhood(int block, int from);
  Conversion conversion(int from, int to, double time) const;
  double stress_curvature(int from, int to) const;

  amr::Forest forest_;
  fluid::Specification specification_;
  Units units_;
  std::vector<Level> levels_;
  std::array<MomentField<S>, 2> field_;
  std::vector<std::uint32_t> in_columns_;  // columns_beside()
  BoundaryFill<S> fill_boundary_;
  bool forced_;                                  // by a body force
  std::vector<Interpolation<S>> interpolation_;  // by the coarser level of an interface
  std::vector<Reflux<S>> reflux_;                // likewise
  fluid::ForceField force_;
  mutable FineVelocity<S> fine_velocity_;  // a cache
  BlockUpdate<S> update_;
  fluid::FluidStatistics statistics_;
};

using Solver = BasicSolver<DefaultStress>;

/// A solver with the storage that the specification asks for (float32 stresses where the processor has no 16-bit ones).
std::unique_ptr<fluid::FluidSolver> make_solver(amr::Forest forest, const fluid::Specification& specification);

}  // namespace drogue::lbm
