// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/stencils.hpp"

#include <algorithm>

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

/// Lagrange weights of four points at position x.
Axis::Weights cubic_weights(const std::array<double, 4>& point, double x) {
  Axis::Weights w{};
  for (int k = 0; k < 4; ++k) {
    double product = 1.0;
    for (int l = 0; l < 4; ++l)
      if (l != k) product *= (x - point[l]) / (point[k] - point[l]);
    w[k] = product;
  }
  return w;
}

/// The second derivative at x of the cubic through 0, 1, 2, 3: (1, -2, 1) at the points 1 and 2, continued linearly.
Axis::Weights cubic_curvature(double x) { return {2.0 - x, 3.0 * x - 5.0, 4.0 - 3.0 * x, x - 1.0}; }

}  // namespace

Axis cubic_axis(int half, bool available) {
  Axis axis{interpolation_taps, {}, {}, {}};
  // the coarse block comes second in the pair for the low half, first for the high one
  const int begin = half == 0 ? n : 0;
  const int low = half == 0 && available ? 0 : begin, high = half == 1 && available ? 2 * n : begin + n;
  for (int i = 0; i < n; ++i) {
    const int coarse = begin + half * n / 2 + i / 2, odd = i & 1;
    axis.start[i] = std::clamp(coarse - 2 + odd, low, high - axis.taps);
    const double x = coarse + (odd ? 0.25 : -0.25) - axis.start[i];
    axis.weight[i] = cubic_weights({0, 1, 2, 3}, x);
    axis.curvature[i] = cubic_curvature(x);
  }
  return axis;
}

JointStencil joint_stencil() {
  const auto [leaf, first, second, third, none] = cubic_weights({-0.75, 0, 1, 2}, -0.25);
  JointStencil joint{{first, second, third}, {}, leaf};
  for (int layer = 0; layer < 3; ++layer) {
    const Axis::Weights there = cubic_curvature(layer);
    for (int k = 0; k < 4; ++k) joint.curvature[k] += joint.weight[layer] * there[k];
  }
  return joint;
}

Axis restriction_axis() {
  Axis axis{restriction_taps, {}, {}, {}};
  for (int i = 0; i < n; ++i) {
    const int child = i / (n / 2), j = i % (n / 2);
    const bool low = j < n / 4;
    // the centred four points stand in five taps, such that an end and the output next to it use the same
    axis.start[i] = child * n + std::clamp(2 * j - (low ? 2 : 1), 0, n - restriction_taps);
    axis.weight[i] = {0, -1, 9, 9, -1};
    axis.curvature[i] = {0, 1, -1, -1, 1};
    if (j == 0 || j == n / 2 - 1) {
      axis.weight[i] = {6, 11, 1, -3, 1};
      axis.curvature[i] = {2, -3, -1, 3, -1};
    }
    if (!low) {
      std::ranges::reverse(axis.weight[i]);
      std::ranges::reverse(axis.curvature[i]);
    }
    for (double& w : axis.weight[i]) w /= 16.0;
    for (double& w : axis.curvature[i]) w /= 2.0;
  }
  return axis;
}

}  // namespace drogue::lbm
