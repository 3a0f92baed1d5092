// SPDX-License-Identifier: GPL-3.0-or-later
// The Saint Venant-Kirchhoff law (saint_venant_kirchhoff.hpp) of a membrane: without stress across it the law stays
// linear in the Green-Lagrange strain E of its plane, with lambda' = 2 lambda mu / (lambda + 2 mu), and
//   E_33 = -lambda / (lambda + 2 mu) tr E,
// so that the thickness vanishes at large strains; the volume ratio then does, which ends a run.
#pragma once

#include "fem/plane_neo_hookean.hpp"
#include "fem/saint_venant_kirchhoff.hpp"

namespace drogue::fem {

struct PlaneSaintVenantKirchhoff {
  SaintVenantKirchhoff solid;

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

  template <class T>
  T volume_ratio(const PlaneTensor<T>& c) const {
    return square_root(larger(thickness_squared(c) * determinant(c), T{}));
  }

  /// Its derivative in the direction dC.
  template <class T>
  T volume_change(const PlaneTensor<T>& c, const PlaneTensor<T>& dc) const {
    const T tt = thickness_squared(c);
    return 0.5 * (tt * determinant_change(c, dc) - contraction() * trace(dc) * determinant(c)) /
           square_root(tt * determinant(c));
  }

  template <class T>
  Uniaxial<T> uniaxial(const T& mu) const {
    const double poisson = 0.5 * solid.lambda / (solid.lambda + solid.shear);
    const double young = 2.0 * solid.shear * (1.0 + poisson);
    const T e = 0.5 * (mu - 1.0), lateral = 1.0 - poisson * (mu - 1.0), stretch = square_root(larger(mu, T{}));
    return {0.5 * young * e * e,   young * e,
            splat<T>(0.5 * young), lateral,
            stretch * lateral,     0.5 * lateral / stretch - poisson * stretch};
  }

 private:
  double contraction() const { return solid.lambda / (solid.lambda + 2.0 * solid.shear); }

  template <class T>
  T thickness_squared(const PlaneTensor<T>& c) const {
    return 1.0 - contraction() * (trace(c) - 2.0);
  }

  template <class T>
  PlaneTensor<T> of_strain(const PlaneTensor<T>& e) const {
    const T spherical = 2.0 * solid.shear * contraction() * trace(e);
    const double twice = 2.0 * solid.shear;
    return {spherical + twice * e.xx, spherical + twice * e.yy, twice * e.xy};
  }
};

}  // namespace drogue::fem
