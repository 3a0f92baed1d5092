// SPDX-License-Identifier: GPL-3.0-or-later
// Tension field of a woven fabric (Epstein & Forcinito, Int. J. Solids Struct. 38 (2001) 5265; Mosler, Comput. Methods
// Appl. Mech. Eng. 197 (2008) 1132, minimise over the folds alike). Folding shortens the sheet at no cost, so its
// energy is the least that W(E + A / 2) takes over all A >= 0, or, W being quadratic with the compliance D,
//   W*(E) = max over S >= 0 of  S : E - S : D : S / 2.
// The mixed criterion follows:
//   taut      the stress of the law is nowhere compressive    W* = W
//   slack     no principal strain is positive                 W* = 0
//   wrinkled  otherwise: S = (E_tt / D_tt) t t, W* = E_tt^2 / (2 D_tt), uniaxial tension along the t that maximises it,
// which is no principal direction of the strain unless it is along a yarn. W* is convex in E and has a continuous
// stress.
#pragma once

#include <cmath>
#include <numbers>

#include "fem/orthotropic_fabric.hpp"
#include "fem/tension_field.hpp"

namespace drogue::fem {

template <>
struct TensionField<OrthotropicFabric> {
  OrthotropicFabric law;

  /// [J/m^3]
  template <class T>
  T energy(const PlaneTensor<T>& c) const {
    const State<T> s(law, c);
    return s.slack ? T{} : s.taut ? law.energy(c) : 0.5 * s.along.stress * s.along.strain;
  }

  /// Second Piola-Kirchhoff stress [Pa]
  template <class T>
  PlaneTensor<T> stress(const PlaneTensor<T>& c) const {
    const State<T> s(law, c);
    return select(s.slack, PlaneTensor<T>{T{}, T{}, T{}},
                  select(s.taut, law.stress(c), s.along.stress * s.along.direction()));
  }

  /// Its derivative in the direction dC; the tension turns as W* stays stationary in its angle.
  template <class T>
  PlaneTensor<T> tangent(const PlaneTensor<T>& c, const PlaneTensor<T>& dc) const {
    const State<T> s(law, c);
    const Uniaxial<T>& u = s.along;
    const PlaneTensor<T> de = splat<T>(0.5) * dc;
    const PlaneTensor<T> turning = (-u.strain_slope / u.compliance) * u.direction() + u.stress * u.direction_slope();
    const T turned = -dot(turning, de) / (0.5 * u.stress * u.strain * u.curvature);
    const PlaneTensor<T> wrinkled = (dot(u.direction(), de) / u.compliance) * u.direction() + turned * turning;
    return select(s.slack, PlaneTensor<T>{T{}, T{}, T{}}, select(s.taut, law.tangent(c, dc), wrinkled));
  }

  /// Of the folded sheet's area, 1 where it is slack.
  template <class T>
  T volume_ratio(const PlaneTensor<T>& c) const {
    return law.volume_ratio(folded(c));
  }

  /// Its derivative in the direction dC.
  template <class T>
  T volume_change(const PlaneTensor<T>& c, const PlaneTensor<T>& dc) const {
    return law.volume_change(folded(c), splat<T>(2.0) * law.strain_of(tangent(c, dc)));
  }

 private:
  /// The right Cauchy-Green tensor along the folded sheet, which its stress belongs to.
  template <class T>
  PlaneTensor<T> folded(const PlaneTensor<T>& c) const {
    const PlaneTensor<T> e = law.strain_of(stress(c));
    return {1.0 + 2.0 * e.xx, 1.0 + 2.0 * e.yy, 2.0 * e.xy};
  }

  /// Tension along t at the angle phi / 2 to the warp.
  template <class T>
  struct Uniaxial {
    T cosine, sine;          ///< of phi
    T strain, strain_slope;  ///< E_tt, and its derivative with phi
    T compliance;            ///< D_tt [1/Pa]
    T stress;                ///< E_tt / D_tt [Pa]
    T slope, curvature;      ///< derivatives of ln(E_tt^2 / D_tt) with phi

    Uniaxial() = default;
    Uniaxial(const OrthotropicFabric& law, const PlaneTensor<T>& e, const T& c, const T& s) : cosine(c), sine(s) {
      const auto [dxx, dyy, mixed] = law.uniaxial_compliance();
      const double constant = 0.25 * (dxx + dyy + mixed), linear = 0.5 * (dxx - dyy),
                   square = 0.25 * (dxx + dyy - mixed);
      const T mean = 0.5 * (e.xx + e.yy), deviation = 0.5 * (e.xx - e.yy);
      strain = mean + deviation * c + e.xy * s;
      strain_slope = e.xy * c - deviation * s;
      compliance = constant + c * (linear + square * c);
      stress = strain / compliance;
      const T rate = linear + 2.0 * square * c;
      const T e1 = strain_slope / strain, e2 = (mean - strain) / strain;
      const T d1 = -rate * s / compliance, d2 = (2.0 * square * s * s - rate * c) / compliance;
      slope = 2.0 * e1 - d1;
      curvature = 2.0 * (e2 - e1 * e1) - (d2 - d1 * d1);
    }

    /// t t, and its derivative with phi.
    PlaneTensor<T> direction() const { return {0.5 + 0.5 * cosine, 0.5 - 0.5 * cosine, 0.5 * sine}; }
    PlaneTensor<T> direction_slope() const { return {-0.5 * sine, 0.5 * sine, 0.5 * cosine}; }
    /// Twice W*, zero where there is no tension.
    T worth() const { return larger(strain, T{}) * larger(stress, T{}); }
  };

  template <class T>
  static Uniaxial<T> best_direction(const OrthotropicFabric& law, const PlaneTensor<T>& e, const T& radius) {
    // From the larger principal strain, or the best of directions all around.
    constexpr int samples = 12;
    const T scale = 1.0 / (radius + 1e-300);
    Uniaxial<T> best(law, e, (0.5 * (e.xx - e.yy)) * scale, e.xy * scale);
    T cosine = best.cosine, sine = best.sine, worth = best.worth();
    for (int k = 0; k < samples; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / samples;
      const T c = splat<T>(std::cos(angle)), s = splat<T>(std::sin(angle));
      const T other = Uniaxial<T>(law, e, c, s).worth();
      const auto better = other > worth;
      cosine = better ? c : cosine;
      sine = better ? s : sine;
      worth = larger(other, worth);
    }
    best = Uniaxial<T>(law, e, cosine, sine);
    constexpr int most_iterations = 30;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      constexpr double most = 0.3;  // [rad] a turn
      const T uphill = best.slope > 0.0 ? splat<T>(most) : splat<T>(-most);
      const T newton = best.curvature < 0.0 ? -best.slope / best.curvature : uphill;
      const T half = 0.5 * (newton > most ? splat<T>(most) : newton < -most ? splat<T>(-most) : newton);
      const T inverse = 1.0 / (1.0 + half * half);  // a rotation by 2 atan(half)
      const T turn_c = (1.0 - half * half) * inverse, turn_s = 2.0 * half * inverse;
      best = Uniaxial<T>(law, e, best.cosine * turn_c - best.sine * turn_s, best.sine * turn_c + best.cosine * turn_s);
      if (is_negligible(half)) break;
    }
    return best;
  }

  template <class T>
  struct State {
    using Mask = decltype(T{} > T{});
    Mask slack, taut;
    Uniaxial<T> along{};  ///< where it is wrinkled

    State(const OrthotropicFabric& law, const PlaneTensor<T>& c) {
      const PlaneTensor<T> e = green_lagrange(c), s = law.stress(c);
      const T deviation = 0.5 * (e.xx - e.yy), radius = square_root(deviation * deviation + e.xy * e.xy);
      slack = 0.5 * (e.xx + e.yy) + radius <= 0.0;
      taut = (trace(s) > 0.0) & (determinant(s) >= 0.0);
      if (!all(slack || taut)) along = best_direction(law, e, radius);
    }
  };
};

}  // namespace drogue::fem
