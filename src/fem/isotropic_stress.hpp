// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/tensor.hpp"

namespace drogue::fem {

/// The first Piola-Kirchhoff stress of an isotropic law, P = linear F + cubic F F^T F + cofactor cof F [Pa]; a law
/// gives the three as its response to I1 = F : F and J.
template <class T>
struct IsotropicStress {
  T linear, cubic, cofactor;
};

/// P(F) [Pa]
template <class Law, class T>
Tensor<T> isotropic_stress(const Law& law, const Tensor<T>& f) {
  const Tensor<T> c = cofactor(f);
  const IsotropicStress<T> p = law.response(dot(f, f), dot(row(f, 0), row(c, 0)));
  const Tensor<T> stress = p.linear * f + p.cofactor * c;
  if constexpr (Law::has_cubic_stress) return stress + p.cubic * (f * gram(f));
  return stress;
}

}  // namespace drogue::fem
