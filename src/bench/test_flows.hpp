// SPDX-License-Identifier: GPL-3.0-or-later
// Flows in a periodic box whose only purpose is to be timed.
#pragma once

#include <memory>
#include <span>

#include "fluid/fluid_solver.hpp"
#include "fluid/specification.hpp"

namespace drogue::bench {

struct Operator {
  const char* name;
  fluid::Collision collision;
  fluid::EddyViscosity eddy;
};

/// Collision operators, with and without eddy viscosity.
std::span<const Operator> operators();
/// The one that cases use unless they say otherwise.
const Operator& default_operator();

/// A shear flow on a uniform grid of `across`^3 cells.
std::unique_ptr<fluid::FluidSolver> uniform_flow(int across, const Operator& op,
                                                 fluid::Storage storage = fluid::Storage::half_stress);

/// The same on `levels` nested cubes, each half as wide as the one around it, so that every level has `across`^3 cells
/// less those that the next one covers.
std::unique_ptr<fluid::FluidSolver> nested_flow(int across, int levels);

}  // namespace drogue::bench
