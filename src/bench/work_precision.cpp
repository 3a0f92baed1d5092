// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/work_precision.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace drogue::bench {

std::vector<int> pareto_front(std::span<const Point> points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, [&](int a, int b) {
    return points[a].seconds != points[b].seconds ? points[a].seconds < points[b].seconds
                                                  : points[a].error < points[b].error;
  });
  std::vector<int> front;
  double smallest = std::numeric_limits<double>::infinity();
  for (const int i : order) {
    if (points[i].error >= smallest) continue;
    smallest = points[i].error;
    front.push_back(i);
  }
  return front;
}

std::optional<int> cheapest_within(std::span<const Point> points, double target) {
  std::optional<int> best;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const bool kept = std::ranges::all_of(points, [&](const Point& other) {
      return other.family != points[i].family || other.resolution < points[i].resolution || other.error <= target;
    });
    if (kept && (!best || points[i].seconds < points[*best].seconds)) best = i;
  }
  return best;
}

}  // namespace drogue::bench
