// SPDX-License-Identifier: GPL-3.0-or-later
// Where the wall time of a run goes.
#pragma once

#include <chrono>

#include "core/archive.hpp"

namespace drogue {

/// Adds up the wall time between `start` and `stop`.
class Stopwatch {
 public:
  void start() { started_ = Clock::now(); }
  void stop() { total_ += Clock::now() - started_; }
  double seconds() const { return std::chrono::duration<double>(total_).count(); }

  /// A continued run goes on counting.
  void transfer_state(Archive& archive) {
    double seconds = this->seconds();
    archive.transfer("seconds", seconds);
    total_ = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point started_{};
  Clock::duration total_{};
};

/// Runs a stopwatch from here to the end of the scope.
class Timed {
 public:
  explicit Timed(Stopwatch& watch) : watch_(watch) { watch_.start(); }
  ~Timed() { watch_.stop(); }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  Stopwatch& watch_;
};

/// Wall time since construction [s], and what is added to it.
class Elapsed {
 public:
  double seconds() const {
    return added_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  void add(double seconds) { added_ += seconds; }

 private:
  double added_ = 0.0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace drogue
