// SPDX-License-Identifier: GPL-3.0-or-later
// When an output is due.
#pragma once

#include <cmath>

namespace drogue::app {

/// Due at the first step that reaches each multiple of an interval, 0 included.
class Schedule {
 public:
  enum class Zero { never, always };  ///< what an interval of zero means

  explicit Schedule(double interval, Zero zero = Zero::never) : interval_(interval), zero_(zero) {}

  /// Whether an output is due at `time` [s], reached by a step of `dt` [s]; if so, waits for the next multiple.
  bool due(double time, double dt) {
    if (interval_ <= 0.0) return zero_ == Zero::always;
    const double slack = 1e-6 * dt;  // time is a sum of steps
    if (time < next_ - slack) return false;
    next_ = interval_ * (std::floor((time + slack) / interval_) + 1.0);
    return true;
  }

  /// What falls due until `time` has been written by the run that is continued.
  void skip(double time, double dt) { due(time, dt); }

 private:
  double interval_, next_ = 0.0;
  Zero zero_;
};

}  // namespace drogue::app
