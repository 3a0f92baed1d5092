// SPDX-License-Identifier: GPL-3.0-or-later
// Snapshots of flow and bodies at their intervals, listed in frames.csv and in ParaView's series files.
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "app/case.hpp"
#include "app/schedule.hpp"
#include "app/simulation.hpp"

namespace drogue::app {

/// Every member that writes throws std::runtime_error naming the file.
class Snapshots {
 public:
  Snapshots(const Output& output, const std::filesystem::path& folder);

  void start();
  /// Goes on after the state that was restored: what was written later is removed.
  void resume(const Simulation& simulation);
  /// Writes what is due.
  void write_due(const Simulation& simulation);

  void transfer_state(Archive& archive);

 private:
  void write_fluid(const fluid::FluidSolver& fluid);
  void write_bodies(double time, const std::vector<std::unique_ptr<CoupledBody>>& bodies);
  void list(const std::string& kind, int index, double time, const std::string& series, const std::string& file);

  std::filesystem::path folder_;
  std::ofstream frames_;
  Schedule fluid_due_, canopy_due_;
  int fluid_index_ = 0, canopy_index_ = 0;
  int listed_ = 0;  // in frames.csv
};

}  // namespace drogue::app
