// SPDX-License-Identifier: GPL-3.0-or-later
// What is measured of the flow as a whole, and along lines. Only what the case asks for is computed.
#pragma once

#include <filesystem>

#include "app/case.hpp"
#include "app/history.hpp"
#include "fluid/fluid_solver.hpp"

namespace drogue::app {

class FlowMeasurements {
 public:
  /// To be made before the first step. `c` outlives it.
  FlowMeasurements(const Case& c, const fluid::FluidSolver& fluid);

  /// What a row of the history says of the flow; the dissipation is a mean since the last call.
  FlowRow measure(const fluid::FluidSolver& fluid);
  /// Samples the profiles of the case into profile_NAME.csv. Throws std::runtime_error naming the file.
  void write_profiles(const std::filesystem::path& folder, const fluid::FluidSolver& fluid) const;

  void transfer_state(Archive& archive);

 private:
  const Case& case_;
  double mass_at_start_;  // [kg]
  double time_before_ = 0.0, energy_before_ = 0.0;
};

}  // namespace drogue::app
