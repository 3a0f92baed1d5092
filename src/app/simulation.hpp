// SPDX-License-Identifier: GPL-3.0-or-later
// Fluid and bodies of a case, stepped together, or bodies without a fluid.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "app/case.hpp"
#include "app/coupled_body.hpp"
#include "app/touching_bodies.hpp"
#include "core/stopwatch.hpp"
#include "fluid/fluid_solver.hpp"

namespace drogue::app {

class Simulation {
 public:
  /// `c` outlives it. Builds grid, fluid and bodies; a mesh that must be generated goes to `folder`. Throws InputError.
  Simulation(const Case& c, const std::filesystem::path& folder);
  ~Simulation();

  /// One coarse step, or one of the structures. Throws Diverged, and InputError for a body that left the fine grid.
  void step();

  double time() const;                                              ///< [s]
  double time_step() const;                                         ///< [s]
  const fluid::FluidSolver* fluid() const { return fluid_.get(); }  ///< null without one
  const std::vector<std::unique_ptr<CoupledBody>>& bodies() const { return bodies_; }

  /// Saves or restores the state between two steps. Throws as Archive does.
  void transfer_state(Archive& archive);

  /// Wall time [s] spent in steps so far, in all and by part.
  double step_seconds() const { return stepping_.seconds(); }
  double structure_seconds() const;
  double coupling_seconds() const;  ///< structure and immersed boundary

 private:
  class TimedHook;

  const Case& case_;
  std::unique_ptr<fluid::FluidSolver> fluid_;
  std::vector<std::unique_ptr<CoupledBody>> bodies_;
  std::unique_ptr<TouchingBodies> touching_;  // null without contact
  std::vector<Mover*> movers_;                // each body alone or with those that it may touch
  std::unique_ptr<TimedHook> hook_;
  int steps_ = 0;  // without a fluid
  Stopwatch stepping_;
};

}  // namespace drogue::app
