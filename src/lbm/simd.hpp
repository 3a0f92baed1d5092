// SPDX-License-Identifier: GPL-3.0-or-later
// One row of a block in one vector: 16 floats, an AVX-512 register. Elsewhere the compiler splits it into what there
// is.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(__AVX512F__) || defined(__F16C__)
#include <immintrin.h>
#endif

namespace drogue::lbm {

inline constexpr int lanes = 16;
using Vec = float __attribute__((vector_size(64)));
using Ivec = std::int32_t __attribute__((vector_size(64)));

// The zero-masking forms of the intrinsics with a full mask compile to the plain instruction; the plain forms raise
// false warnings of uninitialised use (GCC bug 105593).
#ifdef __AVX512F__
inline constexpr __mmask16 all = 0xffff;
#endif

inline Vec load(const float* p) { return *reinterpret_cast<const Vec*>(p); }
inline void store(float* p, Vec v) { *reinterpret_cast<Vec*>(p) = v; }

inline Vec load_unaligned(const float* p) {
  Vec v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline void store_unaligned(float* p, Vec v) { std::memcpy(p, &v, sizeof v); }

inline Vec broadcast(float s) { return Vec{} + s; }

/// Lane i takes lane i - 1; lane 0 takes `first`.
inline Vec shift_up(Vec v, float first) {
#ifdef __AVX512F__
  const __m512i carried = _mm512_castps_si512(_mm512_set1_ps(first));
  return reinterpret_cast<Vec>(
      _mm512_maskz_alignr_epi32(all, _mm512_castps_si512(reinterpret_cast<__m512>(v)), carried, 15));
#else
  alignas(64) float row[lanes + 1];
  row[0] = first;
  store_unaligned(row + 1, v);
  return load(row);
#endif
}

/// Lane i takes lane i + 1; the last lane takes `last`.
inline Vec shift_down(Vec v, float last) {
#ifdef __AVX512F__
  const __m512i carried = _mm512_castps_si512(_mm512_set1_ps(last));
  return reinterpret_cast<Vec>(
      _mm512_maskz_alignr_epi32(all, carried, _mm512_castps_si512(reinterpret_cast<__m512>(v)), 1));
#else
  alignas(64) float row[lanes + 1];
  store(row, v);
  row[lanes] = last;
  return load_unaligned(row + 1);
#endif
}

/// Past the caches: the data will not be read again before it has been evicted.
inline void store_streaming(float* p, Vec v) {
#ifdef __AVX512F__
  _mm512_stream_ps(p, reinterpret_cast<__m512>(v));
#else
  store(p, v);
#endif
}

inline Vec maximum(Vec a, Vec b) { return a > b ? a : b; }

}  // namespace drogue::lbm
