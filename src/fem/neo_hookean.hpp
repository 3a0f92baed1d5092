// SPDX-License-Identifier: GPL-3.0-or-later
// Modified neo-Hookean solid with volumetric stabilisation (paper eqs 5 and 6; Vadala-Roth et al., Comput. Methods
// Appl. Mech. Eng. 365, 2020):
//   Psi = G/2 (J^{-2/3} I1 - 3) + kappa/2 (ln J)^2,   P = G J^{-2/3} (F - I1/3 F^{-T}) + kappa ln J F^{-T}.
// Valid for J > 0; the volumetric term is not convex for J > e, so it is no model of large swelling.
#pragma once

#include "fem/elastic_moduli.hpp"
#include "fem/isotropic_stress.hpp"
#include "fem/simd_math.hpp"
#include "fem/tensor.hpp"

namespace drogue::fem {

struct NeoHookean {
  double shear;  ///< G [Pa]
  double bulk;   ///< kappa_stab [Pa]

  /// `young` [Pa]; the ratio `poisson_stabilisation` fixes the bulk modulus. Throws InputError for values out of range.
  NeoHookean(double young, double poisson, double poisson_stabilisation)
      : shear(shear_modulus(young, poisson)), bulk(bulk_modulus(shear, poisson_stabilisation)) {}

  /// Lateral contraction under small uniaxial stress.
  double poisson() const { return (3.0 * bulk - 2.0 * shear) / (6.0 * bulk + 2.0 * shear); }

  /// Psi(F) [J/m^3]
  template <class T>
  T energy(const Tensor<T>& f) const {
    const T log_j = log(determinant(f));
    return 0.5 * shear * (exp(log_j * (-2.0 / 3.0)) * dot(f, f) - 3.0) + 0.5 * bulk * log_j * log_j;
  }

  static constexpr bool has_cubic_stress = false;
  template <class T>
  IsotropicStress<T> response(const T& i1, const T& j) const {
    const T log_j = log(j);
    const T g = shear * exp(log_j * (-2.0 / 3.0));
    return {g, T{}, (bulk * log_j - g * i1 * (1.0 / 3.0)) / j};
  }
  /// First Piola-Kirchhoff stress P(F) [Pa]
  template <class T>
  Tensor<T> stress(const Tensor<T>& f) const {
    return isotropic_stress(*this, f);
  }

  /// The derivative of the stress at F: gives dP(F; dF) [Pa] of a direction dF.
  template <class T>
  auto tangent(const Tensor<T>& f) const {
    const T j = determinant(f);
    const T log_j = log(j);
    const Tensor<T> f_inverse_transposed = (1.0 / j) * cofactor(f);
    const T g = shear * exp(log_j * (-2.0 / 3.0));
    const T i1 = dot(f, f);
    const T pressure = bulk * log_j - g * i1 * (1.0 / 3.0);
    return [=, *this](const Tensor<T>& df) {
      const T dlog_j = dot(f_inverse_transposed, df);
      const T dg = (-2.0 / 3.0) * g * dlog_j;
      const T dpressure = bulk * dlog_j - (dg * i1 + 2.0 * g * dot(f, df)) * (1.0 / 3.0);
      const Tensor<T> df_inverse_transposed = f_inverse_transposed * (transposed(df) * f_inverse_transposed);
      return g * df + dg * f + dpressure * f_inverse_transposed - pressure * df_inverse_transposed;
    };
  }
};

}  // namespace drogue::fem
