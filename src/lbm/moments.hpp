// SPDX-License-Identifier: GPL-3.0-or-later
// The state of the fluid: ten numbers a cell, (drho, u_x, u_y, u_z) in float32 and the non-equilibrium stress
// Pneq = sum f c c - rho c_s^2 I - rho u u (xx, yy, zz, xy, xz, yz) in the storage type S, all in lattice units.
// Array [block][z][y][moment][x]: the ten moments of a row of 16 cells are adjacent (448 bytes with 16-bit stresses).
// Rounding Pneq touches neither mass nor momentum, which is why it may be kept in 16 bits.
#pragma once

#include <array>
#include <cstddef>

#include "amr/forest.hpp"
#include "core/huge_array.hpp"
#include "lbm/simd.hpp"

namespace drogue::lbm {

static_assert(lanes == amr::block_size);
inline constexpr int rows_per_block = amr::block_size * amr::block_size;
inline constexpr int moments = 10;

enum Moment { drho = 0, ux, uy, uz, pxx, pyy, pzz, pxy, pxz, pyz };

/// Pneq in 16-bit floats, scaled so that its usual range uses their normal numbers.
struct HalfStress {
  using Element = std::uint16_t;
  static constexpr float scale = 1024.0f;
#ifdef __F16C__
  static Vec load(const Element* p) {
#ifdef __AVX512F__
    const __m512 v = _mm512_maskz_cvtph_ps(all, _mm256_load_si256(reinterpret_cast<const __m256i*>(p)));
    return reinterpret_cast<Vec>(v) * (1.0f / scale);
#else
    alignas(64) float v[lanes];
    for (int i = 0; i < lanes; i += 8)
      _mm256_store_ps(v + i, _mm256_cvtph_ps(_mm_load_si128(reinterpret_cast<const __m128i*>(p + i))));
    return lbm::load(v) * (1.0f / scale);
#endif
  }
  static void store(Element* p, Vec v) {
    v *= scale;
#ifdef __AVX512F__
    _mm256_store_si256(reinterpret_cast<__m256i*>(p), _mm512_maskz_cvtps_ph(all, reinterpret_cast<__m512>(v), 0));
#else
    alignas(64) float f[lanes];
    lbm::store(f, v);
    for (int i = 0; i < lanes; i += 8)
      _mm_store_si128(reinterpret_cast<__m128i*>(p + i), _mm256_cvtps_ph(_mm256_load_ps(f + i), 0));
#endif
  }
  static void store_streaming(Element* p, Vec v) {
#ifdef __AVX512F__
    _mm256_stream_si256(reinterpret_cast<__m256i*>(p),
                        _mm512_maskz_cvtps_ph(all, reinterpret_cast<__m512>(v * scale), 0));
#else
    store(p, v);
#endif
  }
  static float get(Element e) { return _cvtsh_ss(e) * (1.0f / scale); }
  static Element put(float s) { return static_cast<Element>(_cvtss_sh(s * scale, 0)); }
#endif
};

struct FloatStress {
  using Element = float;
  static Vec load(const Element* p) { return lbm::load(p); }
  static void store(Element* p, Vec v) { lbm::store(p, v); }
  static void store_streaming(Element* p, Vec v) { lbm::store_streaming(p, v); }
  static float get(Element e) { return e; }
  static Element put(float s) { return s; }
};

#ifdef __F16C__
using DefaultStress = HalfStress;
#else
using DefaultStress = FloatStress;
#endif

/// The ten moments of a row of 16 cells (or of 16 cells of a column) in registers.
struct Row {
  std::array<Vec, moments> m;
};

/// Addresses inside the bytes of one row. S is the storage of Pneq.
template <class S>
struct RowLayout {
  static constexpr std::size_t float_bytes = 4 * lanes * sizeof(float);
  static constexpr std::size_t bytes = float_bytes + 6 * lanes * sizeof(typename S::Element);
  static constexpr std::size_t block_bytes = rows_per_block * bytes;

  static const float* macro(const std::byte* row, int m) { return reinterpret_cast<const float*>(row) + m * lanes; }
  static float* macro(std::byte* row, int m) { return reinterpret_cast<float*>(row) + m * lanes; }
  static const typename S::Element* stress(const std::byte* row, int m) {
    return reinterpret_cast<const typename S::Element*>(row + float_bytes) + (m - 4) * lanes;
  }
  static typename S::Element* stress(std::byte* row, int m) {
    return reinterpret_cast<typename S::Element*>(row + float_bytes) + (m - 4) * lanes;
  }

  static Vec load(const std::byte* row, int m) { return m < 4 ? lbm::load(macro(row, m)) : S::load(stress(row, m)); }
  static void store(std::byte* row, int m, Vec v) {
    if (m < 4)
      lbm::store(macro(row, m), v);
    else
      S::store(stress(row, m), v);
  }
  static float get(const std::byte* row, int m, int x) { return m < 4 ? macro(row, m)[x] : S::get(stress(row, m)[x]); }
  static void put(std::byte* row, int m, int x, float value) {
    if (m < 4)
      macro(row, m)[x] = value;
    else
      stress(row, m)[x] = S::put(value);
  }

  static Row load_row(const std::byte* row) {
    Row r;
    for (int m = 0; m < moments; ++m) r.m[m] = load(row, m);
    return r;
  }
  /// Cells (x, first_row + i * row_stride), i = 0..15, of a block: a column along y (stride 1) or z (stride 16).
  static Row load_column(const std::byte* block, int x, int first_row, int row_stride) {
    alignas(64) float value[moments][lanes];
    for (int i = 0; i < lanes; ++i) {
      const std::byte* row = block + (first_row + i * row_stride) * bytes;
      for (int m = 0; m < moments; ++m) value[m][i] = get(row, m, x);
    }
    Row column;
    for (int m = 0; m < moments; ++m) column.m[m] = lbm::load(value[m]);
    return column;
  }
  static void store_column(std::byte* block, int x, int first_row, int row_stride, const Row& column) {
    for (int i = 0; i < lanes; ++i)
      for (int m = 0; m < moments; ++m) put(block + (first_row + i * row_stride) * bytes, m, x, column.m[m][i]);
  }
  static void store_row(std::byte* row, const Row& r) {
    for (int m = 0; m < moments; ++m) store(row, m, r.m[m]);
  }
};

/// Moments of all blocks of a forest at one time level.
template <class S>
class MomentField {
 public:
  using Layout = RowLayout<S>;

  explicit MomentField(int blocks) : bytes_(blocks * Layout::block_bytes) {}

  std::byte* block(int id) { return bytes_.data() + id * Layout::block_bytes; }
  const std::byte* block(int id) const { return bytes_.data() + id * Layout::block_bytes; }
  std::byte* row(int id, int y, int z) { return block(id) + (z * amr::block_size + y) * Layout::bytes; }
  const std::byte* row(int id, int y, int z) const { return block(id) + (z * amr::block_size + y) * Layout::bytes; }

 private:
  HugeArray bytes_;
};

}  // namespace drogue::lbm
