// SPDX-License-Identifier: GPL-3.0-or-later
// Eddy viscosities of large-eddy simulation from the gradient g[a][b] = du_b/dx_a, in cells^2 per step with the cell as
// filter width, on anything that behaves like a float. Called for one model at compile time, so that a scene without
// one does not pay for any. Roots and quotients are taken to four digits: the constants are not known better.
//   Smagorinsky  C^2 |S|                                              Mon. Weather Rev. 91 (1963) 99
//   Vreman       C sqrt(B_beta / (g : g)), C = 2.5 Cs^2               Phys. Fluids 16 (2004) 3670
//   WALE         C^2 (Sd:Sd)^1.5 / ((S:S)^2.5 + (Sd:Sd)^1.25)         Flow Turbul. Combust. 62 (1999) 183
// The last two vanish in plane shear flow and at walls.
#pragma once

#include <array>

#include "fluid/specification.hpp"
#include "lbm/simd.hpp"

namespace drogue::lbm {

template <class T>
using Gradient = std::array<std::array<T, 3>, 3>;

/// What keeps 0/0 of a fluid at rest from being no number.
inline constexpr float smallest_gradient_squared = 1e-30f;

template <class T>
T strain_squared(const Gradient<T>& g) {
  T sum{};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) sum += g[a][b] * (g[a][b] + g[b][a]);
  return Scalar<T>(0.5) * sum;  // S:S
}

template <class T>
T vreman(const Gradient<T>& g, Scalar<T> factor) {
  T beta[3][3], norm{};
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) beta[i][j] = g[0][i] * g[0][j] + g[1][i] * g[1][j] + g[2][i] * g[2][j];
  for (int i = 0; i < 3; ++i) norm += beta[i][i];
  const T invariant = (beta[0][0] * beta[1][1] - beta[0][1] * beta[0][1]) +
                      (beta[0][0] * beta[2][2] - beta[0][2] * beta[0][2]) +
                      (beta[1][1] * beta[2][2] - beta[1][2] * beta[1][2]);
  return factor *
         rough_square_root(maximum(invariant, T{}) * rough_reciprocal(norm + Scalar<T>(smallest_gradient_squared)));
}

template <class T>
T wale(const Gradient<T>& g, Scalar<T> factor) {
  T square[3][3], trace{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) square[i][j] = g[i][0] * g[0][j] + g[i][1] * g[1][j] + g[i][2] * g[2][j];
  for (int i = 0; i < 3; ++i) trace += square[i][i];
  T traceless{};  // Sd:Sd
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      T s = Scalar<T>(0.5) * (square[i][j] + square[j][i]);
      if (i == j) s -= (Scalar<T>(1) / 3) * trace;
      traceless += s * s;
    }
  const T strain = strain_squared(g), root = rough_square_root(traceless);
  return factor * traceless * root *
         rough_reciprocal(strain * strain * rough_square_root(strain) + traceless * rough_square_root(root) +
                          Scalar<T>(smallest_gradient_squared));
}

/// `factor`: C of Vreman's model, the square of the constant of the others.
template <fluid::EddyViscosity model, class T>
T eddy_viscosity(const Gradient<T>& g, Scalar<T> factor) {
  if constexpr (model == fluid::EddyViscosity::vreman) return vreman(g, factor);
  if constexpr (model == fluid::EddyViscosity::wale) return wale(g, factor);
  return factor * rough_square_root(Scalar<T>(2) * strain_squared(g));
}

}  // namespace drogue::lbm
