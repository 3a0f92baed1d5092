// SPDX-License-Identifier: GPL-3.0-or-later
// The flow between cell centres.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "fluid/fluid_solver.hpp"

namespace drogue::fluid {

/// Reads velocity and pressure anywhere in the domain with cubics through the cells around, the finest for which all of
/// these are there; beside a wall the cubic goes through the four next to it, up to the wall. Blocks are read when they
/// are first asked for, so a probe is made anew after each step.
class Probe {
 public:
  explicit Probe(const FluidSolver& fluid) : fluid_(fluid) {}

  struct Sample {
    Vec3 velocity = Vec3::Zero();  ///< [m/s]
    double pressure = 0.0;         ///< gauge [Pa]
  };
  /// Nothing outside the domain (periodic axes wrap).
  std::optional<Sample> operator()(const Vec3& place);

 private:
  std::optional<Sample> sample(const Vec3& place, int level);
  const BlockFields* fields(int level, const Index3& block);

  const FluidSolver& fluid_;
  std::map<int, std::unique_ptr<BlockFields>> read_;
};

}  // namespace drogue::fluid
