// SPDX-License-Identifier: GPL-3.0-or-later
// Writes what a run shows along its way into its folder: rows of the history and snapshots, as they fall due.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "app/case.hpp"
#include "app/flow_measurements.hpp"
#include "app/history.hpp"
#include "app/schedule.hpp"
#include "app/simulation.hpp"
#include "app/snapshots.hpp"
#include "core/stopwatch.hpp"

namespace drogue::app {

class Recorder {
 public:
  /// To be made before the first step. Every member that writes throws std::runtime_error naming the file.
  Recorder(const Case& c, const Simulation& simulation, const std::filesystem::path& folder);

  /// Opens the files and records the start.
  void start(const Simulation& simulation);
  /// Opens the files of the run whose state was restored, and removes what it recorded after that.
  void resume(const Simulation& simulation);

  /// To be called after every step; the `last` one gets a row in any case.
  void record(const Simulation& simulation, bool last);

  /// To be called when the run ends as it should.
  void finish(const Simulation& simulation);

  /// The rows so far.
  const Trace& trace() const { return history_.trace(); }
  std::optional<double> c_d() const;                   ///< of the last row, of the body that is summarised
  double mlups() const { return mlups_; }              ///< million cell updates a second, between the last two rows
  double seconds() const { return watch_.seconds(); }  ///< wall time spent here

  void transfer_state(Archive& archive);

 private:
  void write_row(const Simulation& simulation);
  void add_coefficients(const Body& body, BodyRow& row) const;

  const Case& case_;
  std::filesystem::path folder_;
  Vec3 flow_direction_;
  History history_;
  Schedule row_due_;
  Snapshots snapshots_;
  std::optional<FlowMeasurements> flow_;
  std::int64_t updates_at_row_ = 0;
  double seconds_at_row_ = 0.0, mlups_ = 0.0;
  Stopwatch watch_;
};

}  // namespace drogue::app
