// SPDX-License-Identifier: GPL-3.0-or-later
// Open faces that let sound out, in lattice units, for one line of cells. Outward normal n, sound speed c.
//
// Outlet: every quantity radiates with the speed of sound,
//   dq/dt + (c + u_n) dq/dn = -K (q - q_far),
// and only the pressure is drawn towards a given value (K = 0 for the velocity, see `draw`). A slow change, such as a
// wake, sees gradients of zero. The characteristic outlet of Poinsot & Lele (J. Comput. Phys. 101 (1992) 104) holds the
// wave that comes in, p - rho c u_n, instead, and takes an eddy's u_n for a wave, an error of rho c u against its own
// pressure of rho u^2: too large at low Mach numbers. Between the cell beyond the face and the one before it the
// equation is solved by the box scheme, second order and all-pass (Mur, IEEE Trans. Electromagn. Compat. 23 (1981)
// 377).
//
// Inlet: pressure radiates; of the two waves, in velocity units a = p/(rho c), the one that comes in is a - u_n. It
// carries the given velocity, and what has come out slowly comes back,
//   a - u_n = m - 2 u_given,   dm/dt = 2 K_in (u_n - u_given),
// so that u_n = u_given in the mean, whatever the pressure.
//
// Waves slower than K come back: K / sqrt(4 omega^2 + K^2) of a plane wave of frequency omega at an outlet, K_in /
// sqrt(omega^2 + K_in^2) at an inlet. The usual K is 1/4 c / L, with L the length of the domain along n (Rudy &
// Strikwerda, J. Comput. Phys. 36 (1980) 55). An inlet and an outlet that face each other settle as exp(s t) with (s +
// K_in)(2 s + K) + K_in K = 0. Twice the usual K and K_in = 2 K make that s = (-0.63 +- 0.33 i) c / L. This
// leaves out how long sound is on its way, L / c: an empty tunnel with two open ends oscillates more than it says.
#pragma once

#include <array>

#include "lbm/moments.hpp"

namespace drogue::lbm {

inline constexpr double sound_speed = 0.57735026918962576;  ///< c in cells per step

inline constexpr double inlet_to_outlet = 2.0;  ///< K_in / K

/// Pressure alone is drawn, and enters by c^2 drho - u_n, of which a wave that comes in, drho = -u_n / c, makes 1 + 1/c
/// times as much: so much more must pressure be drawn for the wave to be drawn by K.
inline constexpr double draw = 1.0 + 1.0 / sound_speed;

/// K / 2 per step, for a domain that is so many cells long.
constexpr double half_relaxation(double cells) { return 0.5 * 0.5 * sound_speed / cells; }

/// What a line of cells at an open face remembers: of an outlet, for drho and u; of an inlet, for drho and m.
template <class Real>
using FaceMemory = std::array<Vec<Real>, 4>;

/// The radiation condition between the cells before (`inside`) and beyond a face: returns the latter's value.
/// `half_rate` is K / 2 per step.
template <class Real>
Vec<Real> radiate(const Vec<Real>& inside, const Vec<Real>& speed, Real half_rate, Real far, Vec<Real>& memory) {
  const Vec<Real> beyond = (memory - (Real(1) - speed + half_rate) * inside) / (Real(1) + speed + half_rate);
  memory = (Real(1) - speed - half_rate) * beyond + (Real(1) + speed - half_rate) * inside + 4 * half_rate * far;
  return beyond;
}

/// Memory of a state that does not change.
template <class Real>
Vec<Real> radiated(const Vec<Real>& value, Real half_rate, Real far) {
  return 2 * (Real(1) - half_rate) * value + 4 * half_rate * far;
}

/// One open face: its outward normal is `sign` along `axis`, `half_rate` K / 2 per step.
template <class Real>
struct OpenFace {
  int axis;
  Real sign, half_rate;

  Vec<Real> speed(const Row<Real>& inside) const { return static_cast<Real>(sound_speed) + sign * inside.m[ux + axis]; }

  Row<Real> outlet(const Row<Real>& inside, Real far, FaceMemory<Real>& memory) const {
    Row<Real> r = inside;
    const Vec<Real> c = speed(inside);
    r.m[drho] = radiate(inside.m[drho], c, static_cast<Real>(draw) * half_rate, far, memory[0]);
    for (int a = 0; a < 3; ++a) r.m[ux + a] = radiate(inside.m[ux + a], c, Real(0), Real(0), memory[1 + a]);
    return r;
  }
  FaceMemory<Real> outlet_memory(const Row<Real>& inside, Real far) const {
    FaceMemory<Real> memory;
    memory[0] = radiated(inside.m[drho], static_cast<Real>(draw) * half_rate, far);
    for (int a = 0; a < 3; ++a) memory[1 + a] = radiated(inside.m[ux + a], Real(0), Real(0));
    return memory;
  }

  Row<Real> inlet(const Row<Real>& inside, const std::array<Vec<Real>, 3>& given, FaceMemory<Real>& memory) const {
    Row<Real> r = inside;
    r.m[drho] = radiate(inside.m[drho], speed(inside), Real(0), Real(0), memory[0]);
    const Vec<Real> wave = pressure_wave(inside.m[drho], r.m[drho]), given_n = sign * given[axis];
    const Vec<Real> u_n = 2 * given_n + wave - memory[1];
    memory[1] += static_cast<Real>(inlet_to_outlet) * 4 * half_rate * (u_n - given_n);
    for (int a = 0; a < 3; ++a) r.m[ux + a] = 2 * (a == axis ? sign * u_n : given[a]) - inside.m[ux + a];
    return r;
  }
  FaceMemory<Real> inlet_memory(const Row<Real>& inside) const {
    const Vec<Real> wave = pressure_wave(inside.m[drho], inside.m[drho]);
    FaceMemory<Real> memory{};
    memory[0] = radiated(inside.m[drho], Real(0), Real(0));
    memory[1] = wave + sign * inside.m[ux + axis];
    return memory;
  }

 private:
  /// p / (rho c) at the face.
  static Vec<Real> pressure_wave(const Vec<Real>& before, const Vec<Real>& beyond) {
    return static_cast<Real>(0.5 * sound_speed) * (before + beyond);
  }
};

}  // namespace drogue::lbm
