// SPDX-License-Identifier: GPL-3.0-or-later
// Tension-field theory (Pipkin, IMA J. Appl. Math. 36 (1986) 85; Steigmann, Proc. R. Soc. A 429 (1990) 141): a membrane
// without bending stiffness folds rather than bear compression. An isotropic law with the principal squared stretches
// mu_1 >= mu_2 is relaxed to
//   slack     mu_1 <= 1                    no energy
//   wrinkled  mu_2 < the lateral one of uniaxial tension by mu_1    the energy of uniaxial tension
//   taut      otherwise                    the law itself.
// Continuous with its stress; the fine wrinkles themselves are not resolved.
#pragma once

#include "fem/plane_neo_hookean.hpp"

namespace drogue::fem {

template <class Law>
struct TensionField {
  Law law;

  /// [J/m^3]
  template <class T>
  T energy(const PlaneTensor<T>& c) const {
    const Principal<T> p(c);
    const Uniaxial<T> u = law.uniaxial(p.larger);
    const auto slack = p.larger <= 1.0, taut = !(p.smaller < u.lateral);
    return slack ? T{} : taut ? law.energy(c_where(taut, c)) : u.energy;
  }

  /// Second Piola-Kirchhoff stress [Pa]
  template <class T>
  PlaneTensor<T> stress(const PlaneTensor<T>& c) const {
    const Principal<T> p(c);
    const Uniaxial<T> u = law.uniaxial(p.larger);
    const auto slack = p.larger <= 1.0, taut = !(p.smaller < u.lateral);
    const T tension = slack ? T{} : u.stress;
    return select(taut & !slack, law.stress(c_where(taut, c)), tension * p.direction);
  }

  /// Its derivative in the direction dC.
  template <class T>
  PlaneTensor<T> tangent(const PlaneTensor<T>& c, const PlaneTensor<T>& dc) const {
    const Principal<T> p(c);
    const Uniaxial<T> u = law.uniaxial(p.larger);
    const auto slack = p.larger <= 1.0, taut = !(p.smaller < u.lateral);
    // d(n n) = (n . dC m) / (mu_1 - mu_2) (n m + m n): what is left of dC, but for its part in n n and m m.
    const PlaneTensor<T> across{1.0 - p.direction.xx, 1.0 - p.direction.yy, -p.direction.xy};
    const T along = dot(p.direction, dc);
    const PlaneTensor<T> turning = dc - along * p.direction - dot(across, dc) * across;
    const PlaneTensor<T> wrinkled = (u.slope * along) * p.direction + (u.stress / p.difference) * turning;
    const T none{};
    return select(taut & !slack, law.tangent(c_where(taut, c), dc),
                  select(slack, PlaneTensor<T>{none, none, none}, wrinkled));
  }

  /// Of the folded sheet: that of the uniaxial tension, or 1 where it is slack.
  template <class T>
  T volume_ratio(const PlaneTensor<T>& c) const {
    const Principal<T> p(c);
    const Uniaxial<T> u = law.uniaxial(p.larger);
    const auto slack = p.larger <= 1.0, taut = !(p.smaller < u.lateral);
    return slack ? splat<T>(1.0) : taut ? law.volume_ratio(c_where(taut, c)) : u.volume_ratio;
  }

  /// Its derivative in the direction dC.
  template <class T>
  T volume_change(const PlaneTensor<T>& c, const PlaneTensor<T>& dc) const {
    const Principal<T> p(c);
    const Uniaxial<T> u = law.uniaxial(p.larger);
    const auto slack = p.larger <= 1.0, taut = !(p.smaller < u.lateral);
    return slack ? T{} : taut ? law.volume_change(c_where(taut, c), dc) : u.volume_slope * dot(p.direction, dc);
  }

 private:
  template <class T>
  struct Principal {
    T larger, smaller, difference;
    PlaneTensor<T> direction;  ///< n n of the larger one

    explicit Principal(const PlaneTensor<T>& c) {
      const T mean = 0.5 * (c.xx + c.yy), deviation = 0.5 * (c.xx - c.yy);
      const T radius = square_root(deviation * deviation + c.xy * c.xy) + 1e-30;
      larger = mean + radius;
      smaller = mean - radius;
      difference = 2.0 * radius;
      const T cosine = deviation / difference;
      direction = {0.5 + cosine, 0.5 - cosine, c.xy / difference};
    }
  };

  /// A harmless argument for the law where it does not count.
  template <class Mask, class T>
  static PlaneTensor<T> c_where(const Mask& taut, const PlaneTensor<T>& c) {
    return select(taut, c, PlaneTensor<T>{splat<T>(1.0), splat<T>(1.0), T{}});
  }
};

}  // namespace drogue::fem
