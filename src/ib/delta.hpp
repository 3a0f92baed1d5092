// SPDX-License-Identifier: GPL-3.0-or-later
// Regularised delta functions, delta(x) = phi(x/dx) phi(y/dx) phi(z/dx) / dx^3. Both kernels satisfy, wherever the
// marker stands between the grid points, sum phi = 1, sum r phi = 0 and sum phi^2 = const; the four-point one also
// keeps the sums over even and odd points equal, so that it cannot feed a checkerboard.
//   peskin4   C. S. Peskin, Acta Numerica 11 (2002) 479, eq. 6.27 (the one with square roots, not the cosine)
//   peskin3   A. M. Roma, C. S. Peskin & M. J. Berger, J. Comput. Phys. 153 (1999) 509
#pragma once

#include <array>
#include <cmath>

namespace drogue::ib {

enum class Delta { peskin4, peskin3 };

/// Grid points per axis that a marker touches.
constexpr int support(Delta delta) { return delta == Delta::peskin4 ? 4 : 3; }

/// Sum of phi^2 over the grid points of one axis, independent of position: 3/8 (four-point), 1/2 (three-point). A sheet
/// of markers drags the fluid mass rho dx / sum_phi_squared per area (Gsell & Favier, J. Comput. Phys. 429 (2021)).
constexpr double sum_phi_squared(Delta delta) { return delta == Delta::peskin4 ? 3.0 / 8.0 : 1.0 / 2.0; }

/// How far before its markers, in cells, a surface appears to a fluid that is sheared on its outer side alone: over the
/// cells that the markers' force is spread to the profile bends from no slope to slope one,
///   u_(i+1) - 2 u_i + u_(i-1) = phi_i,
/// and without slip at the markers, sum phi_i u_i = 0, that slope points at a wall further out. The mean over the
/// places of the grid, about half the mean distance of two points drawn from phi. (W.-P. Breugem, J. Comput. Phys. 231
/// (2012) 4469, who retracts the markers by it, found 0.3 for the three-point function by trial.)
constexpr double wall_offset(Delta delta) { return delta == Delta::peskin4 ? 0.381 : 0.266; }

/// The weights of one axis: cell `low + i` has weight[i]; the three-point kernel leaves the last one zero.
struct AxisWeights {
  int low;
  std::array<double, 4> weight;
};

/// For a marker at `s`, measured in cells from the centre of cell 0.
inline AxisWeights axis_weights(Delta delta, double s) {
  if (delta == Delta::peskin4) {
    const double cell = std::floor(s), r = s - cell;
    const double root = std::sqrt(1.0 + 4.0 * r - 4.0 * r * r);
    const double left = 3.0 - 2.0 * r, right = 1.0 + 2.0 * r;
    return {static_cast<int>(cell) - 1,
            {0.125 * (left - root), 0.125 * (left + root), 0.125 * (right + root), 0.125 * (right - root)}};
  }
  const double cell = std::floor(s + 0.5), r = s - cell;
  const double root = std::sqrt(1.0 - 3.0 * r * r);
  return {static_cast<int>(cell) - 1,
          {(2.0 - 3.0 * r - root) / 6.0, (1.0 + root) / 3.0, (2.0 + 3.0 * r - root) / 6.0, 0.0}};
}

}  // namespace drogue::ib
