// SPDX-License-Identifier: GPL-3.0-or-later
// What is read from the flow behind a body.
#pragma once

#include "core/types.hpp"
#include "fluid/fluid_solver.hpp"

namespace drogue::app {

/// Length [m] of the recirculation on the axis from `rear` along the unit `direction`: up to where the velocity along
/// it turns from backward to forward; 0 if there is no backward flow, or no end of it.
double wake_length(const fluid::FluidSolver& fluid, const Vec3& rear, const Vec3& direction);

}  // namespace drogue::app
