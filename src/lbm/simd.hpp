// SPDX-License-Identifier: GPL-3.0-or-later
// One row of a block in one vector: 16 floats, an AVX-512 register, or 16 doubles, two of them. Elsewhere the compiler
// splits it into what there is.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#if defined(__AVX512F__) || defined(__F16C__)
#include <immintrin.h>
#endif

namespace drogue::lbm {

inline constexpr int lanes = 16;

template <class Real>
struct Pack;
template <>
struct Pack<float> {
  using Type = float __attribute__((vector_size(4 * lanes)));
  using Half = float __attribute__((vector_size(2 * lanes)));
  using Index = std::int32_t __attribute__((vector_size(4 * lanes)));
};
template <>
struct Pack<double> {
  using Type = double __attribute__((vector_size(8 * lanes)));
  using Half = double __attribute__((vector_size(4 * lanes)));
  using Index = std::int64_t __attribute__((vector_size(8 * lanes)));
};
template <class Real>
using Vec = typename Pack<Real>::Type;
/// As many integers, for lane numbers and the results of comparisons.
template <class Real>
using IndexVec = typename Pack<Real>::Index;

/// The number type behind a number or a vector.
template <class T>
struct ScalarOf {
  using Type = T;
};
template <>
struct ScalarOf<Vec<float>> {
  using Type = float;
};
template <>
struct ScalarOf<Vec<double>> {
  using Type = double;
};
template <class T>
using Scalar = typename ScalarOf<T>::Type;

// The zero-masking forms of the intrinsics with a full mask compile to the plain instruction; the plain forms raise
// false warnings of uninitialised use (GCC bug 105593).
#ifdef __AVX512F__
inline constexpr __mmask16 all = 0xffff;
#endif

template <class Real>
Vec<Real> load(const Real* p) {
  return *reinterpret_cast<const Vec<Real>*>(p);
}
template <class Real>
void store(Real* p, Vec<Real> v) {
  *reinterpret_cast<Vec<Real>*>(p) = v;
}

template <class Real>
Vec<Real> load_unaligned(const Real* p) {
  Vec<Real> v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
template <class Real, class V>
void store_unaligned(Real* p, V v) {
  std::memcpy(p, &v, sizeof v);
}

template <class Real>
Vec<Real> broadcast(Real s) {
  return Vec<Real>{} + s;
}

/// Lane i takes lane i - 1; lane 0 takes `first`.
template <class Real>
Vec<Real> shift_up(Vec<Real> v, Real first) {
#ifdef __AVX512F__
  if constexpr (std::is_same_v<Real, float>) {
    const __m512i carried = _mm512_castps_si512(_mm512_set1_ps(first));
    return reinterpret_cast<Vec<Real>>(
        _mm512_maskz_alignr_epi32(all, _mm512_castps_si512(reinterpret_cast<__m512>(v)), carried, 15));
  }
#endif
  alignas(sizeof v) Real row[lanes + 1];
  row[0] = first;
  store_unaligned(row + 1, v);
  return load(row);
}

/// Lane i takes lane i + 1; the last lane takes `last`.
template <class Real>
Vec<Real> shift_down(Vec<Real> v, Real last) {
#ifdef __AVX512F__
  if constexpr (std::is_same_v<Real, float>) {
    const __m512i carried = _mm512_castps_si512(_mm512_set1_ps(last));
    return reinterpret_cast<Vec<Real>>(
        _mm512_maskz_alignr_epi32(all, carried, _mm512_castps_si512(reinterpret_cast<__m512>(v)), 1));
  }
#endif
  alignas(sizeof v) Real row[lanes + 1];
  store(row, v);
  row[lanes] = last;
  return load_unaligned(row + 1);
}

template <class Real>
using HalfVec = typename Pack<Real>::Half;
template <class Real>
HalfVec<Real> low_half(Vec<Real> v) {
  return __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7);
}
template <class Real>
HalfVec<Real> high_half(Vec<Real> v) {
  return __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
}

/// Lanes of two vectors one after the other: lane i takes number `from`[i] of the 32.
template <class Real>
Vec<Real> pick(Vec<Real> low, Vec<Real> high, IndexVec<Real> from) {
  return __builtin_shuffle(low, high, from);
}

template <class Real>
constexpr IndexVec<Real> lane_numbers{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/// The lanes of `a` whose number has `bit` set change places with those of `b` that have not.
template <class Real>
void exchange(Vec<Real>& a, Vec<Real>& b, int bit) {
  const IndexVec<Real> lane = lane_numbers<Real>, has = (lane & bit) != 0;
  const Vec<Real> first = pick<Real>(a, b, has ? (lane ^ bit) + lanes : lane);
  b = pick<Real>(a, b, has ? lane + lanes : (lane ^ bit));
  a = first;
}

/// Past the caches: the data will not be read again before it has been evicted.
template <class Real>
void store_streaming(Real* p, Vec<Real> v) {
#ifdef __AVX512F__
  if constexpr (std::is_same_v<Real, float>) {
    _mm512_stream_ps(p, reinterpret_cast<__m512>(v));
  } else {
    const auto* half = reinterpret_cast<const __m512d*>(&v);
    _mm512_stream_pd(p, half[0]);
    _mm512_stream_pd(p + lanes / 2, half[1]);
  }
#else
  store(p, v);
#endif
}

template <class V>
V maximum(V a, V b) {
  return a > b ? a : b;
}

/// 1 / v, to a few units in the last place.
template <class T>
T reciprocal(T v) {
  return Scalar<T>(1) / v;
}
/// The same to four digits at least.
template <class T>
T rough_reciprocal(T v) {
  return reciprocal(v);
}
inline float rough_square_root(float s) { return std::sqrt(s); }
inline double rough_square_root(double s) { return std::sqrt(s); }
template <class V>
V rough_square_root(V v) {
  for (int i = 0; i < lanes; ++i) v[i] = std::sqrt(v[i]);
  return v;
}

#ifdef __AVX512F__
// The divider takes ten cycles and more for a vector of floats, an estimate one, and a step of Newton's method two.
inline Vec<float> rough_reciprocal(Vec<float> v) {
  return reinterpret_cast<Vec<float>>(_mm512_maskz_rcp14_ps(all, reinterpret_cast<__m512>(v)));
}
inline Vec<float> reciprocal(Vec<float> v) {
  const Vec<float> r = rough_reciprocal(v);
  return r * (2.0f - v * r);
}
inline Vec<float> rough_square_root(Vec<float> v) {
  const __mmask16 positive = _mm512_cmp_ps_mask(reinterpret_cast<__m512>(v), _mm512_setzero_ps(), _CMP_GT_OQ);
  return v * reinterpret_cast<Vec<float>>(_mm512_maskz_rsqrt14_ps(positive, reinterpret_cast<__m512>(v)));
}
#endif

}  // namespace drogue::lbm
