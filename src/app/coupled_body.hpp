// SPDX-License-Identifier: GPL-3.0-or-later
// A body as the run sees it, whatever it is made of.
#pragma once

#include <filesystem>
#include <string>

#include "app/case.hpp"
#include "app/history.hpp"
#include "fluid/fluid_solver.hpp"

namespace drogue::app {

/// What moves by itself: a body, or several that touch. In the fluid by on_fine_step().
class Mover : public fluid::FineStepHook {
 public:
  /// Without a fluid, moves over `dt` from `time` [s] on. Throws Diverged.
  virtual void step_alone(double time, double dt) = 0;
  /// Wall time spent in structures so far [s].
  virtual double structure_seconds() const { return 0.0; }
};

/// Stays where it is made, since its parts refer to each other.
class CoupledBody : public Mover {
 public:
  explicit CoupledBody(const Body& body) : description(body) {}
  CoupledBody(const CoupledBody&) = delete;
  CoupledBody& operator=(const CoupledBody&) = delete;

  /// What a row of the history says, but for the coefficients; forces are means since the last call.
  virtual BodyRow measure(const fluid::FluidSolver* fluid) = 0;
  /// Writes a `.vtu` of the body as it is at `time` [s]. Throws std::runtime_error naming the file.
  virtual void write(const std::filesystem::path& file, double time) const = 0;
  /// A few lines about what follows from its description.
  virtual std::string report(const Case& c) const = 0;
  /// How its structure moves or comes to rest, as the case says it; empty without one.
  virtual std::string solver() const { return {}; }
  /// What a user should know of what it did so far; empty if all is well.
  virtual std::string warning() const { return {}; }
  virtual void transfer_state(Archive& archive) = 0;

  const Body& description;
};

}  // namespace drogue::app
