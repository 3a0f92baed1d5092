// SPDX-License-Identifier: GPL-3.0-or-later
// Averages of the flow over the volume of the domain. Every cell of a leaf counts with its volume; the order of the
// sums does not depend on the number of threads.
#pragma once

#include <array>

#include "core/expression.hpp"
#include "fluid/fluid_solver.hpp"

namespace drogue::fluid {

/// <u^2> / 2 [m^2/s^2].
double kinetic_energy(const FluidSolver& fluid);

/// <|curl u|^2> / 2 [1/s^2], by differences of fourth order, one-sided where a block's neighbour is of another level or
/// none. In a periodic domain 2 nu times it is the viscous dissipation of an incompressible flow.
double enstrophy(const FluidSolver& fluid);

/// sqrt(<|u - v|^2> / <|v|^2>) with the velocity v [m/s] given as formulas, at the time of the fluid.
double relative_velocity_error(const FluidSolver& fluid, const std::array<Expression, 3>& velocity);

}  // namespace drogue::fluid
