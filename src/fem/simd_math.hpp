// SPDX-License-Identifier: GPL-3.0-or-later
// A pack of doubles as wide as the machine's vector registers, and the elementary functions that the hyperelastic laws
// need of it. They are templates, so that the same arithmetic runs for one double.
//
// Range: positive normal numbers for log, |x| < 700 for exp. Error below 4e-16 relative to max(|log x|, 1) and 8e-16
// (tested); outside that range the result is some number, never a trap.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace drogue::fem {

#if defined(__AVX512F__)
inline constexpr int lanes = 8;
#elif defined(__AVX__)
inline constexpr int lanes = 4;
#else
inline constexpr int lanes = 2;
#endif

using Pack = double __attribute__((vector_size(lanes * sizeof(double))));
using IntegerPack = std::uint64_t __attribute__((vector_size(lanes * sizeof(double))));

namespace detail {

template <class T>
struct IntegerOf;
template <>
struct IntegerOf<double> {
  using type = std::uint64_t;
};
template <>
struct IntegerOf<Pack> {
  using type = IntegerPack;
};

/// Adding it to a small number leaves the nearest integer in the low bits of the sum.
inline constexpr double round_shift = 0x1.8p52;
/// ln 2 in two parts, the first short enough for its product with an exponent to be exact.
inline constexpr double log_2 = 0x1.62e42feep-1;
inline constexpr double log_2_tail = 0x1.a39ef35793c76p-33;

/// Sum of c[k] x^k by pairs (Estrin): short chains of dependent operations, which is what limits a kernel.
template <class T, int n>
inline T polynomial(T x, const double (&c)[n]) {
  T sum[(n + 1) / 2];
  for (int k = 0; k < n / 2; ++k) sum[k] = c[2 * k] + x * c[2 * k + 1];
  if constexpr (n % 2 == 1) sum[n / 2] = T{} + c[n - 1];
  for (int size = (n + 1) / 2; size > 1; size = (size + 1) / 2) {
    x = x * x;
    for (int k = 0; k < size / 2; ++k) sum[k] = sum[2 * k] + x * sum[2 * k + 1];
    if (size % 2 == 1) sum[size / 2] = sum[size - 1];
  }
  return sum[0];
}

}  // namespace detail

template <class T>
inline T splat(double value) {
  return T{} + value;
}

template <class T>
inline T larger(const T& a, const T& b) {
  return a > b ? a : b;
}

/// Whether a condition holds in every lane.
inline bool all(bool condition) { return condition; }
template <class Mask>
inline bool all(const Mask& condition) {
  bool every = true;
  for (int lane = 0; lane < lanes; ++lane) every &= condition[lane] != 0;
  return every;
}

inline double square_root(double x) { return std::sqrt(x); }
inline Pack square_root(const Pack& x) {
  Pack root;
  for (int lane = 0; lane < lanes; ++lane) root[lane] = std::sqrt(x[lane]);
  return root;
}

/// Whether a correction by Newton's method of a number of order one, in every lane, no longer matters. So does one that
/// is no number.
inline bool is_negligible(double change) { return !(std::abs(change) > 1e-13); }
inline bool is_negligible(const Pack& change) {
  bool all = true;
  for (int lane = 0; lane < lanes; ++lane) all &= is_negligible(change[lane]);
  return all;
}

/// Natural logarithm: x = 2^e m with m in [sqrt(1/2), sqrt(2)), ln m = 2 atanh((m - 1) / (m + 1)).
template <class T>
inline T log(const T& x) {
  using Integer = typename detail::IntegerOf<T>::type;
  constexpr std::uint64_t sqrt_half = 0x3fe6a09e667f3bcd, bias = 1024;
  const Integer bits = std::bit_cast<Integer>(x);
  const Integer biased = (bits + ((bias << 52) - sqrt_half)) >> 52;
  const T e =
      std::bit_cast<T>(biased + std::bit_cast<std::uint64_t>(detail::round_shift)) - (detail::round_shift + bias);
  const T m = std::bit_cast<T>(bits - ((biased - bias) << 52));

  const T s = (m - 1.0) / (m + 1.0);
  const T z = s * s;
  const T series =
      detail::polynomial(z, {1.0 / 3, 1.0 / 5, 1.0 / 7, 1.0 / 9, 1.0 / 11, 1.0 / 13, 1.0 / 15, 1.0 / 17, 1.0 / 19});
  return e * detail::log_2 + (2.0 * s + (2.0 * s * z * series + e * detail::log_2_tail));
}

/// Exponential: x = n ln 2 + r with |r| <= ln(2) / 2, Taylor series of exp(r), n added to the exponent.
template <class T>
inline T exp(const T& x) {
  using Integer = typename detail::IntegerOf<T>::type;
  const T shifted = x * 0x1.71547652b82fep0 + detail::round_shift;
  const T n = shifted - detail::round_shift;
  const T r = (x - n * detail::log_2) - n * detail::log_2_tail;
  const T series = detail::polynomial(r, {1.0, 1.0, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040,
                                          1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600});
  return std::bit_cast<T>(std::bit_cast<Integer>(series) + (std::bit_cast<Integer>(shifted) << 52));
}

}  // namespace drogue::fem
