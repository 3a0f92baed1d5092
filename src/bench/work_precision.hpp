// SPDX-License-Identifier: GPL-3.0-or-later
// Which of several settings are worth their time.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drogue::bench {

struct Point {
  std::string family;    ///< settings that differ in resolution only
  int resolution = 0;    ///< cells across
  double seconds = 0.0;  ///< that it took
  double error = 0.0;
};

/// Indices of the points that no other point beats in both time and error, by increasing time (Pareto front).
std::vector<int> pareto_front(std::span<const Point> points);

/// The cheapest point whose error, and that of all finer points of its family, is at most `target`; one whose error
/// happens to be small while finer grids err more does not count. Nothing if there is none.
std::optional<int> cheapest_within(std::span<const Point> points, double target);

}  // namespace drogue::bench
