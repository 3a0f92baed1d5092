// SPDX-License-Identifier: GPL-3.0-or-later
// Linear cable: tension per reference section proportional to the stretch beyond 1, P = E (lambda - 1); one that bears
// tension only is slack below 1.
#pragma once

#include "fem/simd_math.hpp"

namespace drogue::fem {

struct LinearCable {
  double young = 0.0;  ///< E [Pa]
  bool tension_only = false;

  /// [J/m^3]
  template <class T>
  T energy(const T& stretch) const {
    const T strain = strain_of(stretch);
    return 0.5 * young * strain * strain;
  }

  /// Tension per reference section [Pa]
  template <class T>
  T stress(const T& stretch) const {
    return young * strain_of(stretch);
  }

  /// Its derivative with the stretch [Pa]
  template <class T>
  T tangent(const T& stretch) const {
    return tension_only ? (stretch < 1.0 ? T{} : splat<T>(young)) : splat<T>(young);
  }

  /// Stretch, but 1 of a slack cable, which may fold.
  template <class T>
  T volume_ratio(const T& stretch) const {
    return 1.0 + strain_of(stretch);
  }

 private:
  template <class T>
  T strain_of(const T& stretch) const {
    const T strain = stretch - 1.0;
    return tension_only ? (strain < 0.0 ? T{} : strain) : strain;
  }
};

}  // namespace drogue::fem
