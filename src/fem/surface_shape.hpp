// SPDX-License-Identifier: GPL-3.0-or-later
// Shape functions of surface elements at their Gauss points, on the parent square [-1, 1]^2 or the parent triangle
// (0, 0), (1, 0), (0, 1).
#pragma once

#include "fem/hex_topology.hpp"

namespace drogue::fem {

template <std::size_t N>
struct SurfaceShape;

template <>
struct SurfaceShape<3> {
  static constexpr int points = 1;
  static constexpr double weight = 0.5;
  static constexpr double value[1][3] = {{1.0 / 3, 1.0 / 3, 1.0 / 3}};
  static constexpr double gradient[1][3][2] = {{{-1.0, -1.0}, {1.0, 0.0}, {0.0, 1.0}}};
  static constexpr double centre_gradient[3][2] = {{-1.0, -1.0}, {1.0, 0.0}, {0.0, 1.0}};
};

template <>
struct SurfaceShape<4> {
  static constexpr int points = 4;
  static constexpr double weight = 1.0;
  static constexpr double near = 0.5 * (1.0 + gauss_abscissa), far = 1.0 - near;
  /// [Gauss point, in order around][node]
  static constexpr double value[4][4] = {{near * near, near* far, far* far, near* far},
                                         {near * far, near* near, near* far, far* far},
                                         {far * far, near* far, near* near, near* far},
                                         {near * far, far* far, near* far, near* near}};
  static constexpr double n = 0.5 * near, f = 0.5 * far;
  static constexpr double gradient[4][4][2] = {{{-n, -n}, {n, -f}, {f, f}, {-f, n}},
                                               {{-n, -f}, {n, -n}, {f, n}, {-f, f}},
                                               {{-f, -f}, {f, -n}, {n, n}, {-n, f}},
                                               {{-f, -n}, {f, -f}, {n, f}, {-n, n}}};
  static constexpr double centre_gradient[4][2] = {{-0.25, -0.25}, {0.25, -0.25}, {0.25, 0.25}, {-0.25, 0.25}};
};

}  // namespace drogue::fem
