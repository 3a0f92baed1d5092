// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric second-order tensors in the plane of a membrane, whose components are numbers or packs of numbers.
#pragma once

namespace drogue::fem {

template <class T>
struct PlaneTensor {
  T xx, yy, xy;
};

template <class T>
inline PlaneTensor<T> operator+(const PlaneTensor<T>& a, const PlaneTensor<T>& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.xy + b.xy};
}

template <class T>
inline PlaneTensor<T> operator-(const PlaneTensor<T>& a, const PlaneTensor<T>& b) {
  return {a.xx - b.xx, a.yy - b.yy, a.xy - b.xy};
}

template <class T>
inline PlaneTensor<T> operator*(const T& s, const PlaneTensor<T>& a) {
  return {s * a.xx, s * a.yy, s * a.xy};
}

template <class T>
inline T trace(const PlaneTensor<T>& a) {
  return a.xx + a.yy;
}

template <class T>
inline T determinant(const PlaneTensor<T>& a) {
  return a.xx * a.yy - a.xy * a.xy;
}

/// Of the determinant in the direction da.
template <class T>
inline T determinant_change(const PlaneTensor<T>& a, const PlaneTensor<T>& da) {
  return a.xx * da.yy + a.yy * da.xx - 2.0 * (a.xy * da.xy);
}

/// a : b
template <class T>
inline T dot(const PlaneTensor<T>& a, const PlaneTensor<T>& b) {
  return a.xx * b.xx + a.yy * b.yy + 2.0 * (a.xy * b.xy);
}

template <class T>
inline PlaneTensor<T> inverse(const PlaneTensor<T>& a) {
  const T scale = 1.0 / determinant(a);
  return {scale * a.yy, scale * a.xx, -scale * a.xy};
}

/// a b a for symmetric a and b.
template <class T>
inline PlaneTensor<T> sandwich(const PlaneTensor<T>& a, const PlaneTensor<T>& b) {
  const T xx = a.xx * b.xx + a.xy * b.xy, xy = a.xx * b.xy + a.xy * b.yy;
  const T yx = a.xy * b.xx + a.yy * b.xy, yy = a.xy * b.xy + a.yy * b.yy;
  return {xx * a.xx + xy * a.xy, yx * a.xy + yy * a.yy, xx * a.xy + xy * a.yy};
}

/// (c - I) / 2, the Green-Lagrange strain of the right Cauchy-Green tensor c.
template <class T>
inline PlaneTensor<T> green_lagrange(const PlaneTensor<T>& c) {
  return {0.5 * (c.xx - 1.0), 0.5 * (c.yy - 1.0), 0.5 * c.xy};
}

/// Where `mask` holds `a`, elsewhere `b`.
template <class Mask, class T>
inline PlaneTensor<T> select(const Mask& mask, const PlaneTensor<T>& a, const PlaneTensor<T>& b) {
  return {mask ? a.xx : b.xx, mask ? a.yy : b.yy, mask ? a.xy : b.xy};
}

}  // namespace drogue::fem
