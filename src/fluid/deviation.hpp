// SPDX-License-Identifier: GPL-3.0-or-later
// How far the flow in a box is from rest, or from a uniform flow: what a wave or an eddy has left behind.
#pragma once

#include "fluid/fluid_solver.hpp"

namespace drogue::fluid {

/// Largest |u - velocity| [m/s] in the cells of leaves whose centres lie in the box [m].
double largest_velocity_deviation(const FluidSolver& fluid, const Box& box, const Vec3& velocity);

/// Largest |p| [Pa] there.
double largest_pressure(const FluidSolver& fluid, const Box& box);

}  // namespace drogue::fluid
