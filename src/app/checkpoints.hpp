// SPDX-License-Identifier: GPL-3.0-or-later
// The checkpoints of a run: the newest two are kept, and a run is continued from the newest that can be read.
#pragma once

#include <filesystem>
#include <string>

#include "app/recorder.hpp"
#include "app/simulation.hpp"
#include "core/log.hpp"
#include "core/stopwatch.hpp"

namespace drogue::app {

class Checkpoints {
 public:
  /// Every `interval` [s] of wall time; 0 for none. `wall` is the time of the run so far.
  Checkpoints(const std::filesystem::path& folder, double interval, Simulation& simulation, Recorder& recorder,
              Elapsed& wall, Log& log);

  bool due() const { return interval_ > 0.0 && since_last_.seconds() >= interval_; }
  /// Between two steps. What cannot be written is a warning: the run goes on without.
  void write();
  /// Gives simulation and recorder the newest state that can be read; a newer one that cannot is a warning. Throws
  /// InputError if there is none, or if it is not of this simulation.
  void restore();

  /// Where the newest one is and what it is of, to be appended to a message; nothing if there is none.
  std::string hint() const;
  double seconds() const { return watch_.seconds(); }  ///< wall time spent here

  void transfer_state(Archive& archive);

 private:
  std::filesystem::path folder_;
  double interval_;
  Simulation& simulation_;
  Recorder& recorder_;
  Elapsed& wall_;
  Log& log_;
  int next_ = 1;  // number of the next file
  double newest_time_ = -1.0;
  Elapsed since_last_;
  Stopwatch watch_;
};

}  // namespace drogue::app
