// SPDX-License-Identifier: GPL-3.0-or-later
// How far a run is: one live line on a terminal, a plain line every twentieth of the run anywhere else.
#pragma once

#include <optional>

#include "core/log.hpp"
#include "core/stopwatch.hpp"

namespace drogue::app {

class Progress {
 public:
  /// From `begin` to `end` [s]; a quiet one shows nothing.
  Progress(double begin, double end, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `time` [s] simulated, `mlups` million cell updates a second, drag coefficient if there is a body.
  void update(double time, double mlups, std::optional<double> c_d);
  /// Ends the live line, so that other lines may follow.
  void clear();

 private:
  double begin_, end_;
  bool quiet_, live_;
  bool line_open_ = false;
  int shown_;                // twentieths
  double last_draw_ = -1.0;  // [s]
  Elapsed elapsed_;
};

}  // namespace drogue::app
