// SPDX-License-Identifier: GPL-3.0-or-later
// Woven fabric: linear between the second Piola-Kirchhoff stress and the Green-Lagrange strain in the axes of the
// yarns, warp (x) and weft (y), with moduli per thickness:
//   S_xx = (E_1 E_xx + nu_12 E_2 E_yy) / (1 - nu_12 nu_21),  S_yy alike,  S_xy = 2 G E_xy,  nu_21 = nu_12 E_2 / E_1.
// The thickness of a fabric is not told by its law; its volume ratio is that of the area.
#pragma once

#include <array>

#include "fem/plane_tensor.hpp"
#include "fem/simd_math.hpp"

namespace drogue::fem {

struct OrthotropicFabric {
  double warp, weft, coupling, shear;  ///< coefficients of the law [Pa]

  /// `young_warp`, `young_weft` and `shear_modulus` [Pa] positive; `poisson` is the contraction of the weft by stress
  /// in the warp, with poisson^2 < young_warp / young_weft. Throws InputError otherwise.
  OrthotropicFabric(double young_warp, double young_weft, double poisson, double shear_modulus);

  /// [J/m^3]
  template <class T>
  T energy(const PlaneTensor<T>& c) const {
    const PlaneTensor<T> e = green_lagrange(c);
    return 0.5 * dot(of_strain(e), e);
  }

  /// Second Piola-Kirchhoff stress [Pa]
  template <class T>
  PlaneTensor<T> stress(const PlaneTensor<T>& c) const {
    return of_strain(green_lagrange(c));
  }

  /// Its derivative in the direction dC.
  template <class T>
  PlaneTensor<T> tangent(const PlaneTensor<T>&, const PlaneTensor<T>& dc) const {
    return of_strain(splat<T>(0.5) * dc);
  }

  /// Green-Lagrange strain under a stress [Pa], the inverse of the law.
  template <class T>
  PlaneTensor<T> strain_of(const PlaneTensor<T>& s) const {
    const double inverse = 1.0 / (warp * weft - coupling * coupling);
    return {inverse * (weft * s.xx - coupling * s.yy), inverse * (warp * s.yy - coupling * s.xx), (0.5 / shear) * s.xy};
  }

  /// Strain along a uniaxial stress in the direction t is {0} t_x^4 + {1} t_y^4 + {2} t_x^2 t_y^2 times it [1/Pa].
  std::array<double, 3> uniaxial_compliance() const {
    const double inverse = 1.0 / (warp * weft - coupling * coupling);
    return {inverse * weft, inverse * warp, 1.0 / shear - 2.0 * inverse * coupling};
  }

  template <class T>
  T volume_ratio(const PlaneTensor<T>& c) const {
    return square_root(larger(determinant(c), T{}));
  }

  /// Its derivative in the direction dC.
  template <class T>
  T volume_change(const PlaneTensor<T>& c, const PlaneTensor<T>& dc) const {
    return 0.5 * determinant_change(c, dc) / square_root(determinant(c));
  }

 private:
  template <class T>
  PlaneTensor<T> of_strain(const PlaneTensor<T>& e) const {
    return {warp * e.xx + coupling * e.yy, coupling * e.xx + weft * e.yy, 2.0 * shear * e.xy};
  }
};

}  // namespace drogue::fem
