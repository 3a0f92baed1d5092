// SPDX-License-Identifier: GPL-3.0-or-later
// Saint Venant-Kirchhoff solid (paper eqs 7 to 10):
//   E = (F^T F - I) / 2,   Psi = lambda/2 (tr E)^2 + mu tr(E^2),   P = F (lambda tr(E) I + 2 mu E).
// Softens without bound in compression: its stress falls below a stretch of 1/sqrt(3), and nothing keeps J positive.
#pragma once

#include "fem/elastic_moduli.hpp"
#include "fem/isotropic_stress.hpp"
#include "fem/simd_math.hpp"
#include "fem/tensor.hpp"

namespace drogue::fem {

struct SaintVenantKirchhoff {
  double shear;   ///< mu [Pa]
  double lambda;  ///< [Pa]

  /// `young` [Pa]. Throws InputError for values out of range.
  SaintVenantKirchhoff(double young, double poisson)
      : shear(shear_modulus(young, poisson)), lambda(bulk_modulus(shear, poisson) - shear * (2.0 / 3.0)) {}

  /// Lateral contraction under small uniaxial stress.
  double poisson() const { return 0.5 * lambda / (lambda + shear); }

  /// Psi(F) [J/m^3]
  template <class T>
  T energy(const Tensor<T>& f) const {
    const Tensor<T> e = green_lagrange(f);
    return 0.5 * lambda * trace(e) * trace(e) + shear * dot(e, e);
  }

  static constexpr bool has_cubic_stress = true;
  template <class T>
  IsotropicStress<T> response(const T& i1, const T&) const {
    return {0.5 * lambda * (i1 - 3.0) - shear, splat<T>(shear), T{}};
  }
  /// First Piola-Kirchhoff stress P(F) [Pa]
  template <class T>
  Tensor<T> stress(const Tensor<T>& f) const {
    return isotropic_stress(*this, f);
  }

  /// The derivative of the stress at F: gives dP(F; dF) [Pa] of a direction dF.
  template <class T>
  auto tangent(const Tensor<T>& f) const {
    return [f, stress = second_piola(green_lagrange(f)), *this](const Tensor<T>& df) {
      const Tensor<T> ft_df = transposed(f) * df;
      const Tensor<T> de = splat<T>(0.5) * (ft_df + transposed(ft_df));
      return df * stress + f * second_piola(de);
    };
  }

 private:
  template <class T>
  static Tensor<T> green_lagrange(const Tensor<T>& f) {
    const Tensor<T> c = gram(f);
    return tensor<T>([&](int i, int j) { return 0.5 * (i == j ? c(i, j) - 1.0 : c(i, j)); });
  }

  template <class T>
  Tensor<T> second_piola(const Tensor<T>& e) const {
    const T spherical = lambda * trace(e);
    return tensor<T>([&](int i, int j) {
      const T s = 2.0 * shear * e(i, j);
      return i == j ? s + spherical : s;
    });
  }
};

}  // namespace drogue::fem
