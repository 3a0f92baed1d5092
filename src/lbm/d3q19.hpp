// SPDX-License-Identifier: GPL-3.0-or-later
// The D3Q19 lattice between moments and populations, in lattice units, on anything that behaves like a float.
//
// Populations are deviations from the weights, f_i - w_i. A post-collision population is the Hermite series
//   g_i = w_i [ drho + 3 c.j + 9/2 cc:A - 3/2 tr A + third order ],  j = rho u,  A = rho u u + (1 - 1/tau) Pneq,
// whose third order is what D3Q19 can hold isotropically, with recursive coefficients
//   a_abc = rho u_a u_b u_c + (1 - 1/tau)(u_a Pneq_bc + u_b Pneq_ac + u_c Pneq_ab).
// Without the third order it is the lattice BGK scheme of the moments that are kept (Latt & Chopard, Math. Comput.
// Simul. 72 (2006) 165). References: Malaspinas, arXiv:1505.06900 (2015); Jacob, Malaspinas & Sagaut, J. Turbul. 19
// (2018) 1051.
//
// Where a step changes a velocity by little more than its last bit, what rounds the same way in every step adds up to a
// viscosity of its own. Constants are therefore exact or corrected by their excess(), and 1 + drho, which floats hold
// to 6e-8 only, is neither multiplied nor divided by: j = u + drho u, u = j - (drho / rho) j.
#pragma once

#include <array>
#include <type_traits>
#include <utility>

#include "lbm/moments.hpp"

namespace drogue::lbm {

/// Is (cx, cy, cz) a velocity of D3Q19?
constexpr bool in_lattice(int cx, int cy, int cz) { return cx * cx + cy * cy + cz * cz <= 2; }

/// By how much the constant 1/n of this type exceeds the fraction, relative to it.
template <class Real>
constexpr Real excess(int n) {
  if constexpr (std::is_same_v<Real, float>)
    return static_cast<float>(n * double{1.0f / n} - 1.0);
  else
    return Real(0);  // of doubles of no account
}

/// What all populations of a cell share: the coefficients of the series, times the weight 1/36 of a diagonal one. All
/// constants are then powers of two but 1/36 of the isotropic part and 1/12 of the momentum.
template <class T, bool third_order = true>
struct HermiteSeries {
  using Real = Scalar<T>;
  T base;                     // (drho - 3/2 tr A) / 36
  std::array<T, 3> normal;    // 9/2 A_aa / 36
  std::array<T, 3> shear;     // 9 A_ab / 36 for (y, z), (x, z), (x, y): named by the axis left out
  std::array<T, 3> axis;      // odd part of the population along an axis
  std::array<T, 3> odd_next;  // odd part along a in the diagonals of the plane (a, a + 1)
  std::array<T, 3> odd_prev;  // odd part along a in the diagonals of the plane (a, a - 1)

  /// `keep` = 1 - 1/tau, the share of Pneq that survives the collision.
  HermiteSeries(const std::array<T, moments>& m, Real keep) {
    const T surplus = m[drho] - excess<Real>(12);  // rho - 1, and what 1/12 is too large by
    const std::array<T, 3> u{m[ux], m[uy], m[uz]};
    const std::array<T, 3> j{u[0] + surplus * u[0], u[1] + surplus * u[1], u[2] + surplus * u[2]};
    const std::array<T, 3> p{m[pxx], m[pyy], m[pzz]};
    const std::array<T, 3> s{m[pyz], m[pxz], m[pxy]};
    std::array<T, 3> a, b, off;
    for (int i = 0; i < 3; ++i) {
      const int k = (i + 1) % 3, l = (i + 2) % 3;
      const T inertia = j[i] * u[i];
      a[i] = inertia + keep * p[i];
      b[i] = a[i] - Real(2) * inertia;
      off[i] = j[k] * u[l] + keep * s[i];
      normal[i] = Real(0.125) * a[i];
      shear[i] = Real(0.25) * off[i];
    }
    const T isotropic = m[drho] - Real(1.5) * (a[0] + a[1] + a[2]);
    base = (Real(1) / 36) * isotropic - (excess<Real>(36) / 36) * isotropic;  // fused: the first product is not rounded
    for (int i = 0; i < 3; ++i) {
      odd_next[i] = odd_prev[i] = (Real(1) / 12) * j[i];
      axis[i] = odd_next[i] + odd_prev[i];
      if constexpr (third_order) {
        const int k = (i + 1) % 3, l = (i + 2) % 3;
        // a_ikk = u_i (A_kk - 2 rho u_k u_k) + 2 u_k A_ik, and the same with l
        const T a_ikk = u[i] * b[k] + Real(2) * u[k] * off[l];
        const T a_ill = u[i] * b[l] + Real(2) * u[l] * off[k];
        axis[i] -= Real(0.5) * (a_ikk + a_ill);
        odd_next[i] += Real(0.25) * a_ikk;
        odd_prev[i] += Real(0.25) * a_ill;
      }
    }
  }

  /// Post-collision population of velocity c, less its weight.
  template <int cx, int cy, int cz>
  T population() const {
    constexpr std::array<int, 3> c{cx, cy, cz};
    constexpr int nonzero = cx * cx + cy * cy + cz * cz;
    if constexpr (nonzero == 0) {
      return Real(12) * base;
    } else if constexpr (nonzero == 1) {
      constexpr int i = cx ? 0 : cy ? 1 : 2;
      const T even = Real(2) * (base + normal[i]);
      return c[i] > 0 ? even + axis[i] : even - axis[i];
    } else {
      constexpr int out = !cx ? 0 : !cy ? 1 : 2;
      constexpr int i = (out + 1) % 3, k = (out + 2) % 3;
      const T sum = base + normal[i] + normal[k];
      const T even = c[i] * c[k] > 0 ? sum + shear[out] : sum - shear[out];
      const T along_i = c[i] > 0 ? even + odd_next[i] : even - odd_next[i];
      return c[k] > 0 ? along_i + odd_prev[k] : along_i - odd_prev[k];
    }
  }
};

/// The population of a direction that is known at run time only; `third_order` as the collision has it.
template <class Real>
Vec<Real> population_along(const Row<Real>& line, Real keep, bool third_order, const Index3& c) {
  Vec<Real> v{};
  const int wanted = amr::neighbour_slot(c[0], c[1], c[2]);
  const auto choose = [&]<class Series, int... slot>(const Series& g, std::integer_sequence<int, slot...>) {
    const auto try_slot = [&]<int s>(std::integral_constant<int, s>) {
      constexpr Index3 o = amr::slot_offset(s);
      if constexpr (in_lattice(o[0], o[1], o[2]))
        if (s == wanted) v = g.template population<o[0], o[1], o[2]>();
    };
    (try_slot(std::integral_constant<int, slot>{}), ...);
  };
  constexpr auto slots = std::make_integer_sequence<int, 27>{};
  if (third_order)
    choose(HermiteSeries<Vec<Real>, true>(line.m, keep), slots);
  else
    choose(HermiteSeries<Vec<Real>, false>(line.m, keep), slots);
  return v;
}

/// Moments of populations given by `f.template get<cx, cy, cz>()`: drho, u and Pneq.
template <class T, class Populations>
std::array<T, moments> moments_of(const Populations& f) {
  struct Plane {
    T even, cross, along_first, along_second;  // sums over the four diagonals of one plane
  };
  const auto diagonals = [](T pp, T mm, T pm, T mp) {
    return Plane{(pp + mm) + (pm + mp), (pp + mm) - (pm + mp), (pp - mm) + (pm - mp), (pp - mm) - (pm - mp)};
  };
  const Plane xy = diagonals(f.template get<1, 1, 0>(), f.template get<-1, -1, 0>(), f.template get<1, -1, 0>(),
                             f.template get<-1, 1, 0>());
  const Plane xz = diagonals(f.template get<1, 0, 1>(), f.template get<-1, 0, -1>(), f.template get<1, 0, -1>(),
                             f.template get<-1, 0, 1>());
  const Plane yz = diagonals(f.template get<0, 1, 1>(), f.template get<0, -1, -1>(), f.template get<0, 1, -1>(),
                             f.template get<0, -1, 1>());
  const T px = f.template get<1, 0, 0>(), nx = f.template get<-1, 0, 0>();
  const T py = f.template get<0, 1, 0>(), ny = f.template get<0, -1, 0>();
  const T pz = f.template get<0, 0, 1>(), nz = f.template get<0, 0, -1>();

  const T xx = (px + nx) + (xy.even + xz.even);
  const T yy = (py + ny) + (xy.even + yz.even);
  const T zz = (pz + nz) + (xz.even + yz.even);
  std::array<T, moments> m;
  m[drho] = f.template get<0, 0, 0>() + ((px + nx) + (py + ny) + (pz + nz)) + (xy.even + xz.even + yz.even);
  const T jx = (px - nx) + (xy.along_first + xz.along_first);
  const T jy = (py - ny) + (xy.along_second + yz.along_first);
  const T jz = (pz - nz) + (xz.along_second + yz.along_second);
  const T surplus = m[drho] * reciprocal(Scalar<T>(1) + m[drho]);  // (rho - 1) / rho
  m[ux] = jx - surplus * jx;
  m[uy] = jy - surplus * jy;
  m[uz] = jz - surplus * jz;
  const T pressure = (Scalar<T>(1) / 3) * m[drho];
  m[pxx] = xx - pressure - jx * m[ux];
  m[pyy] = yy - pressure - jy * m[uy];
  m[pzz] = zz - pressure - jz * m[uz];
  m[pxy] = xy.cross - jx * m[uy];
  m[pxz] = xz.cross - jx * m[uz];
  m[pyz] = yz.cross - jy * m[uz];
  return m;
}

}  // namespace drogue::lbm
