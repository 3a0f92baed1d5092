// SPDX-License-Identifier: GPL-3.0-or-later
// What a run comes down to: peaks, means over the stable window with their drift, and how they compare with references.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/case.hpp"
#include "core/archive.hpp"

namespace drogue::app {

/// The history of one body, one entry a row. A value belongs to the time since the row before, from 0 on.
struct Trace {
  std::vector<double> time;  ///< [s]
  std::vector<double> c_d;
  std::vector<double> centre_dx;        ///< [m]
  std::vector<double> slip_normal;      ///< [m/s]
  std::vector<double> face_difference;  ///< [m/s]
  std::vector<double> slip_rms;         ///< [m/s]
  std::vector<double> wake_length;      ///< in widths of the body

  void transfer_state(Archive& archive);
};

struct Result {
  std::string name, unit;
  std::optional<double> value;  ///< nothing if the run ended before its time
};

struct Comparison {
  Reference reference;
  std::optional<double> value;
  double difference = 0.0;  ///< relative
  bool agrees = false;
};

/// Mean of `value` over the window [s], each row weighted with the part of its time that lies inside; nothing if the
/// rows do not cover the window.
std::optional<double> window_mean(const std::vector<double>& time, const std::vector<double>& value,
                                  const std::array<double, 2>& window);
/// Mean of the window's second half less that of its first, over the mean of the whole.
std::optional<double> window_drift(const std::vector<double>& time, const std::vector<double>& value,
                                   const std::array<double, 2>& window);

/// The results that such a body has.
std::vector<Result> summarise(const Trace& trace, const Body& body, const ResultOptions& options);
std::vector<Comparison> compare(const std::vector<Result>& results, const std::vector<Reference>& references);

/// Names of the results that such a body has, which references may name.
std::vector<std::string> result_names(const Body& body);

}  // namespace drogue::app
