// SPDX-License-Identifier: GPL-3.0-or-later
// The modified neo-Hookean law (neo_hookean.hpp) of a membrane. With C the right Cauchy-Green tensor in its plane and t
// the thickness stretch, J = t sqrt(det C), I1 = tr C + t^2 and g = G J^{-2/3}, no stress across it means
//   g (2 t^2 - tr C) / 3 + kappa ln J = 0,
// which increases with ln t, so that Newton's method finds its one root; then the second Piola-Kirchhoff stress in the
// plane is S = g (I - t^2 C^{-1}).
#pragma once

#include "fem/neo_hookean.hpp"
#include "fem/plane_tensor.hpp"

namespace drogue::fem {

/// What a law says of a membrane in tension along one direction and free of stress across it, as a function of the
/// squared stretch mu along it.
template <class T>
struct Uniaxial {
  T energy;         ///< [J/m^3]
  T stress, slope;  ///< second Piola-Kirchhoff [Pa], and its derivative with mu
  T lateral;        ///< squared stretch in the plane across the tension
  T volume_ratio, volume_slope;
};

struct PlaneNeoHookean {
  NeoHookean solid;

  /// [J/m^3]
  template <class T>
  T energy(const PlaneTensor<T>& c) const {
    const State<T> s = state(c);
    return energy_of(s.log_j, trace(c) + s.thickness_squared);
  }

  /// Second Piola-Kirchhoff stress [Pa]
  template <class T>
  PlaneTensor<T> stress(const PlaneTensor<T>& c) const {
    const State<T> s = state(c);
    return s.g * deviation(inverse(c), s.thickness_squared);
  }

  /// Its derivative in the direction dC.
  template <class T>
  PlaneTensor<T> tangent(const PlaneTensor<T>& c, const PlaneTensor<T>& dc) const {
    const State<T> s = state(c);
    const PlaneTensor<T> c_inverse = inverse(c);
    const T tt = s.thickness_squared;
    const T dlog_area = 0.5 * dot(c_inverse, dc), dlog_t = thickness_change(s, c, dlog_area, dc);
    const T dlog_g = (-2.0 / 3.0) * (dlog_area + dlog_t);
    return (s.g * dlog_g) * deviation(c_inverse, tt) -
           (s.g * tt) * ((2.0 * dlog_t) * c_inverse - sandwich(c_inverse, dc));
  }

  template <class T>
  T volume_ratio(const PlaneTensor<T>& c) const {
    return exp(state(c).log_j);
  }

  /// Its derivative in the direction dC.
  template <class T>
  T volume_change(const PlaneTensor<T>& c, const PlaneTensor<T>& dc) const {
    const State<T> s = state(c);
    const T dlog_area = 0.5 * dot(inverse(c), dc);
    return exp(s.log_j) * (dlog_area + thickness_change(s, c, dlog_area, dc));
  }

  /// Both lateral stretches are equal, t: g (t^2 - mu) / 3 + kappa ln J = 0.
  template <class T>
  Uniaxial<T> uniaxial(const T& mu) const {
    const T log_stretch = 0.5 * log(mu);
    T log_t = -0.5 * log_stretch, log_j, g, tt, rise;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      log_j = log_stretch + 2.0 * log_t;
      g = solid.shear * exp((-2.0 / 3.0) * log_j);
      tt = exp(2.0 * log_t);
      rise = g * (2.0 * tt + 4.0 * mu) * (1.0 / 9.0) + 2.0 * solid.bulk;
      const T change = -(g * (tt - mu) * (1.0 / 3.0) + solid.bulk * log_j) / rise;
      log_t = log_t + change;
      if (is_negligible(change)) break;
    }
    const T half_over_mu = 0.5 / mu;
    const T dlog_t = -(half_over_mu * (solid.bulk - (2.0 / 9.0) * g * (tt - mu)) - (1.0 / 3.0) * g) / rise;
    const T dlog_j = half_over_mu + 2.0 * dlog_t, dlog_g = (-2.0 / 3.0) * dlog_j, share = tt / mu, j = exp(log_j);
    return {energy_of(log_j, mu + 2.0 * tt),
            g * (1.0 - share),
            g * (dlog_g * (1.0 - share) + share * (1.0 / mu - 2.0 * dlog_t)),
            tt,
            j,
            j * dlog_j};
  }

 private:
  template <class T>
  struct State {
    T thickness_squared, log_j, g;
  };
  static constexpr int most_iterations = 30;

  template <class T>
  T energy_of(const T& log_j, const T& i1) const {
    return 0.5 * solid.shear * (exp((-2.0 / 3.0) * log_j) * i1 - 3.0) + 0.5 * solid.bulk * log_j * log_j;
  }

  template <class T>
  static PlaneTensor<T> deviation(const PlaneTensor<T>& c_inverse, const T& thickness_squared) {
    return {1.0 - thickness_squared * c_inverse.xx, 1.0 - thickness_squared * c_inverse.yy,
            -thickness_squared * c_inverse.xy};
  }

  /// Derivative of the stress across, times t, with ln t.
  template <class T>
  T slope(const T& g, const T& thickness_squared, const T& trace) const {
    return (2.0 / 9.0) * g * (4.0 * thickness_squared + trace) + solid.bulk;
  }

  /// d(ln t) in the direction dC, in which the logarithm of the area changes by `dlog_area`.
  template <class T>
  T thickness_change(const State<T>& s, const PlaneTensor<T>& c, const T& dlog_area, const PlaneTensor<T>& dc) const {
    const T tt = s.thickness_squared, tr = trace(c);
    return (dlog_area * ((2.0 / 9.0) * s.g * (2.0 * tt - tr) - solid.bulk) + (1.0 / 3.0) * s.g * trace(dc)) /
           slope(s.g, tt, tr);
  }

  /// Newton's method from the thickness of an incompressible sheet.
  template <class T>
  State<T> state(const PlaneTensor<T>& c) const {
    const T log_area = 0.5 * log(determinant(c)), tr = trace(c);
    T log_t = -log_area;
    State<T> s;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      s.log_j = log_area + log_t;
      s.g = solid.shear * exp((-2.0 / 3.0) * s.log_j);
      s.thickness_squared = exp(2.0 * log_t);
      const T change = -((1.0 / 3.0) * s.g * (2.0 * s.thickness_squared - tr) + solid.bulk * s.log_j) /
                       slope(s.g, s.thickness_squared, tr);
      if (is_negligible(change)) break;
      log_t = log_t + change;
    }
    return s;
  }
};

}  // namespace drogue::fem
