// SPDX-License-Identifier: GPL-3.0-or-later
// What a run comes down to: peaks, means over the stable window with their drift, last values, and how they compare
// with references. A result is a statistic of one column of the history; results.cpp lists them, those of a body and
// those of the flow.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/case.hpp"
#include "core/archive.hpp"

namespace drogue::app {

/// The history of a run, one entry a row. A value belongs to the time since the row before, from 0 on.
struct Trace {
  std::vector<double> time;                           ///< [s]
  std::map<std::string, std::vector<double>> column;  ///< named as in history.csv: "mass_drift", "plate.c_d"

  /// Takes the columns that are there.
  void transfer_state(Archive& archive);
};

struct Result {
  std::string name, unit;
  std::optional<double> value;  ///< nothing if the run ended before its time
};

struct Comparison {
  Reference reference;
  std::optional<double> value;
  double difference = 0.0;  ///< relative, or in full from a reference of zero
  bool agrees = false;
};

/// Mean of `value` over the window [s], each row weighted with the part of its time that lies inside; nothing if the
/// rows do not cover the window.
std::optional<double> window_mean(const std::vector<double>& time, const std::vector<double>& value,
                                  const std::array<double, 2>& window);
/// Mean of the window's second half less that of its first, over the mean of the whole.
std::optional<double> window_drift(const std::vector<double>& time, const std::vector<double>& value,
                                   const std::array<double, 2>& window);

/// The results that the case has; `trace` holds its columns.
std::vector<Result> summarise(const Trace& trace, const Case& c);
std::vector<Comparison> compare(const std::vector<Result>& results, const std::vector<Reference>& references);

/// Names of the results that the case has, which references may name.
std::vector<std::string> result_names(const Case& c);

}  // namespace drogue::app
