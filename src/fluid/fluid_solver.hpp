// SPDX-License-Identifier: GPL-3.0-or-later
// The contract between a fluid and everything that drives it. Both fluids (lattice Boltzmann, projection) promise
// the same meaning of every member, so the immersed boundary and the coupling are shared.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "amr/forest.hpp"
#include "core/archive.hpp"
#include "fluid/views.hpp"

namespace drogue::fluid {

/// One sub-step of the finest level, valid only during the hook call. `time` is the end of the sub-step: u_star is the
/// velocity there, before any immersed-boundary force; the force acts over the whole `dt`.
struct FineStep {
  double time, dt;             ///< [s]
  const VelocityView& u_star;  ///< [m/s]
  ForceField& f;               ///< [N/m^3] empty on entry, to be filled
  double velocity_per_force;   ///< kappa [m^3 s/kg]: u = u_star + kappa f
};

/// What acts on the fluid once per finest sub-step: prescribed motion, a coupled structure.
class FineStepHook {
 public:
  virtual ~FineStepHook() = default;
  virtual void on_fine_step(FineStep& step) = 0;
};

/// Macroscopic fields of one block on a row-major grid [z][y][x].
struct BlockFields {
  std::array<std::array<float, amr::block_cells>, 3> velocity;  ///< [m/s]
  std::array<float, amr::block_cells> pressure;                 ///< gauge [Pa]
};

struct FluidStatistics {
  std::int64_t cell_updates = 0;  ///< since the start, all levels
  double max_mach = 0.0;          ///< largest |u| / c_s over the last coarse step (0 for an incompressible solver)
  double max_speed = 0.0;         ///< [m/s] over the last coarse step
};

class FluidSolver {
 public:
  virtual ~FluidSolver() = default;

  /// Advances one coarse step; calls `hook` (if any) once per finest sub-step. Throws Diverged.
  virtual void step(FineStepHook* hook) = 0;

  virtual const amr::Forest& forest() const = 0;
  virtual double time() const = 0;       ///< [s]
  virtual double coarse_dt() const = 0;  ///< [s]
  virtual double fine_dt() const = 0;    ///< [s] of the finest level
  virtual const FluidStatistics& statistics() const = 0;

  /// Velocity of the finest level at `time()`.
  virtual VelocityView fine_velocity() const = 0;
  /// Fields of a leaf or a parent at `time()`; parents hold the average of their children.
  virtual void read_block(int block, BlockFields& fields) const = 0;
  /// Total mass [kg] and momentum [kg m/s] over the leaves.
  virtual std::array<double, 4> mass_and_momentum() const = 0;

  /// Saves or restores the state between two coarse steps; a solver of the same forest and specification that restored
  /// it goes on with the same bits.
  virtual void transfer_state(Archive& archive) = 0;
};

}  // namespace drogue::fluid
