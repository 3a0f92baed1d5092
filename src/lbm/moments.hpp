// SPDX-License-Identifier: GPL-3.0-or-later
// The state of the fluid: ten numbers a cell, (drho, u_x, u_y, u_z) in float32 and the non-equilibrium stress
// Pneq = sum f c c - rho c_s^2 I - rho u u (xx, yy, zz, xy, xz, yz) in the storage type S, all in lattice units.
// Array [block][z][y][moment][x]: the ten moments of a row of 16 cells are adjacent (448 bytes with 16-bit stresses).
// Rounding Pneq touches neither mass nor momentum, which is why it may be kept in 16 bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "amr/forest.hpp"
#include "core/huge_array.hpp"
#include "lbm/simd.hpp"

namespace drogue::lbm {

static_assert(lanes == amr::block_size);
inline constexpr int rows_per_block = amr::block_size * amr::block_size;
inline constexpr int moments = 10;

enum Moment { drho = 0, ux, uy, uz, pxx, pyy, pzz, pxy, pxz, pyz };

/// Storage types of the state: `Real` of density, velocity and arithmetic, `Element` of the stress.

/// Pneq in 16-bit floats, scaled so that its usual range uses their normal numbers.
struct HalfStress {
  using Real = float;
  using Element = std::uint16_t;
  static constexpr float scale = 1024.0f;
#ifdef __F16C__
  /// As they are stored, `scale` times too large: for linear combinations.
  static Vec<float> load_scaled(const Element* p) {
#ifdef __AVX512F__
    return reinterpret_cast<Vec<float>>(
        _mm512_maskz_cvtph_ps(all, _mm256_load_si256(reinterpret_cast<const __m256i*>(p))));
#else
    alignas(64) float v[lanes];
    for (int i = 0; i < lanes; i += 8)
      _mm256_store_ps(v + i, _mm256_cvtph_ps(_mm_load_si128(reinterpret_cast<const __m128i*>(p + i))));
    return lbm::load(v);
#endif
  }
  static Vec<float> load(const Element* p) { return load_scaled(p) * (1.0f / scale); }
  static void store(Element* p, Vec<float> v) { store_scaled(p, v * scale); }
  static void store_scaled(Element* p, Vec<float> v) {
#ifdef __AVX512F__
    _mm256_store_si256(reinterpret_cast<__m256i*>(p), _mm512_maskz_cvtps_ph(all, reinterpret_cast<__m512>(v), 0));
#else
    alignas(64) float f[lanes];
    lbm::store(f, v);
    for (int i = 0; i < lanes; i += 8)
      _mm_store_si128(reinterpret_cast<__m128i*>(p + i), _mm256_cvtps_ph(_mm256_load_ps(f + i), 0));
#endif
  }
  /// Half of a vector.
  static void store_half_scaled(Element* p, HalfVec<float> v) {
    alignas(32) float f[lanes / 2];
    std::memcpy(f, &v, sizeof v);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm256_cvtps_ph(_mm256_load_ps(f), 0));
  }
  /// What load_scaled() finds after store().
  static Vec<float> as_stored(Vec<float> v) {
    alignas(32) Element e[lanes];
    store(e, v);
    return load_scaled(e);
  }
  static void store_streaming(Element* p, Vec<float> v) {
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

/// Everything in one floating-point type.
template <class T>
struct PlainStress {
  using Real = T;
  using Element = T;
  static Vec<T> load(const T* p) { return lbm::load(p); }
  static Vec<T> load_scaled(const T* p) { return lbm::load(p); }
  static void store(T* p, Vec<T> v) { lbm::store(p, v); }
  static void store_scaled(T* p, Vec<T> v) { lbm::store(p, v); }
  static void store_half_scaled(T* p, HalfVec<T> v) { store_unaligned(p, v); }
  static Vec<T> as_stored(Vec<T> v) { return v; }
  static void store_streaming(T* p, Vec<T> v) { lbm::store_streaming(p, v); }
  static T get(T e) { return e; }
  static T put(T s) { return s; }
};
using FloatStress = PlainStress<float>;
using DoubleStress = PlainStress<double>;

#ifdef __F16C__
using DefaultStress = HalfStress;
#else
using DefaultStress = FloatStress;
#endif

/// The ten moments of a row of 16 cells (or of 16 cells of a column) in registers.
template <class Real>
struct Row {
  std::array<Vec<Real>, moments> m;
};

/// Addresses inside the bytes of one row. S is the storage.
template <class S>
struct RowLayout {
  using Real = typename S::Real;
  static constexpr std::size_t macro_bytes = 4 * lanes * sizeof(Real);
  static constexpr std::size_t bytes = macro_bytes + 6 * lanes * sizeof(typename S::Element);
  static constexpr std::size_t block_bytes = rows_per_block * bytes;

  static const Real* macro(const std::byte* row, int m) { return reinterpret_cast<const Real*>(row) + m * lanes; }
  static Real* macro(std::byte* row, int m) { return reinterpret_cast<Real*>(row) + m * lanes; }
  static const typename S::Element* stress(const std::byte* row, int m) {
    return reinterpret_cast<const typename S::Element*>(row + macro_bytes) + (m - 4) * lanes;
  }
  static typename S::Element* stress(std::byte* row, int m) {
    return reinterpret_cast<typename S::Element*>(row + macro_bytes) + (m - 4) * lanes;
  }

  static Vec<Real> load(const std::byte* row, int m) {
    return m < 4 ? lbm::load(macro(row, m)) : S::load(stress(row, m));
  }
  static void store(std::byte* row, int m, Vec<Real> v) {
    if (m < 4)
      lbm::store(macro(row, m), v);
    else
      S::store(stress(row, m), v);
  }
  /// The same with the stress as the storage scales it, which saves work where moments are only combined linearly.
  static Vec<Real> load_scaled(const std::byte* row, int m) {
    return m < 4 ? lbm::load(macro(row, m)) : S::load_scaled(stress(row, m));
  }
  static void store_scaled(std::byte* row, int m, Vec<Real> v) {
    if (m < 4)
      lbm::store(macro(row, m), v);
    else
      S::store_scaled(stress(row, m), v);
  }
  /// The lower or upper eight cells of a row.
  static void store_half_scaled(std::byte* row, int m, int half, HalfVec<Real> v) {
    if (m < 4)
      store_unaligned(macro(row, m) + half * lanes / 2, v);
    else
      S::store_half_scaled(stress(row, m) + half * lanes / 2, v);
  }
  static Real get(const std::byte* row, int m, int x) { return m < 4 ? macro(row, m)[x] : S::get(stress(row, m)[x]); }
  static void put(std::byte* row, int m, int x, Real value) {
    if (m < 4)
      macro(row, m)[x] = value;
    else
      stress(row, m)[x] = S::put(value);
  }

  static Row<Real> load_row(const std::byte* row) {
    Row<Real> r;
    for (int m = 0; m < moments; ++m) r.m[m] = load(row, m);
    return r;
  }
  static void store_row(std::byte* row, const Row<Real>& r) {
    for (int m = 0; m < moments; ++m) store(row, m, r.m[m]);
  }
  static void store_row_streaming(std::byte* row, const Row<Real>& r) {
    for (int m = 0; m < 4; ++m) lbm::store_streaming(macro(row, m), r.m[m]);
    for (int m = 4; m < moments; ++m) S::store_streaming(stress(row, m), r.m[m]);
  }
  /// Element `x` of the rows `first_row` + i * `row_stride`, i = 0..15: a column of a block along y (stride 1) or z
  /// (16).
  static Row<Real> load_column(const std::byte* rows, int x, int first_row, int row_stride) {
    alignas(128) Real value[moments][lanes];
    for (int i = 0; i < lanes; ++i) {
      const std::byte* row = rows + (first_row + i * row_stride) * bytes;
      for (int m = 0; m < moments; ++m) value[m][i] = get(row, m, x);
    }
    Row<Real> column;
    for (int m = 0; m < moments; ++m) column.m[m] = lbm::load(value[m]);
    return column;
  }
  /// The 16 cells from `cell` along x, y or z, its component there being 0.
  static Row<Real> load_line(const std::byte* rows, const Index3& cell, int along) {
    const auto [x, y, z] = cell;
    if (along == 0) return load_row(rows + (z * lanes + y) * bytes);
    return along == 1 ? load_column(rows, x, z * lanes, 1) : load_column(rows, x, y, lanes);
  }
  static void store_column(std::byte* rows, int x, int first_row, int row_stride, const Row<Real>& column) {
    for (int i = 0; i < lanes; ++i)
      for (int m = 0; m < moments; ++m) put(rows + (first_row + i * row_stride) * bytes, m, x, column.m[m][i]);
  }
  /// Element `i` of a row to element `j` of another.
  static void copy_element(const std::byte* from, int i, std::byte* to, int j) {
    for (int m = 0; m < 4; ++m) macro(to, m)[j] = macro(from, m)[i];
    for (int m = 4; m < moments; ++m) stress(to, m)[j] = stress(from, m)[i];
  }
};

/// Moments of all blocks of a forest at one time level. The cells at the two x faces are kept once more, as columns
/// along y, [x face][z][moment][y]: a neighbour that needs them would else touch every cache line of the block, because
/// a row lies along x.
/// Who changes such a cell of a leaf calls add(), refresh_columns() or velocity_to_columns(). Of ghosts and parents the
/// rims at the x faces exist as columns alone, unless level_transfer.hpp says otherwise; of what lies beyond the x
/// faces of the domain columns are all there is.
template <class S>
class MomentField {
 public:
  using Layout = RowLayout<S>;
  using Real = typename S::Real;
  static constexpr std::size_t column_bytes = 2 * amr::block_size * Layout::bytes;

  explicit MomentField(int blocks)
      : rows_(blocks * Layout::block_bytes), columns_(blocks * column_bytes), changed_(blocks, false) {}

  std::byte* block(int id) { return rows_.data() + id * Layout::block_bytes; }
  const std::byte* block(int id) const { return rows_.data() + id * Layout::block_bytes; }
  std::byte* row(int id, int y, int z) { return block(id) + (z * amr::block_size + y) * Layout::bytes; }
  const std::byte* row(int id, int y, int z) const { return block(id) + (z * amr::block_size + y) * Layout::bytes; }
  std::byte* columns(int id) { return columns_.data() + id * column_bytes; }
  const std::byte* columns(int id) const { return columns_.data() + id * column_bytes; }

  /// The column at (x, z); x must be 0 or 15.
  std::byte* column(int id, int x, int z) { return const_cast<std::byte*>(std::as_const(*this).column(id, x, z)); }
  const std::byte* column(int id, int x, int z) const {
    return columns(id) + ((x > 0 ? amr::block_size : 0) + z) * Layout::bytes;
  }

  /// A line of 16 cells in the layer `layer` along `normal` (0 x, 1 y, 2 z): a column next to an x face, else a row.
  std::byte* line(int id, int normal, int layer, int across) {
    return const_cast<std::byte*>(std::as_const(*this).line(id, normal, layer, across));
  }
  const std::byte* line(int id, int normal, int layer, int across) const {
    if (normal == 0) return column(id, layer, across);
    return normal == 1 ? row(id, layer, across) : row(id, across, layer);
  }

  /// The 16 cells from `first` along x, y or z, its component there being 0: from the rows, or from the columns, of
  /// which there are lines along y and z.
  Row<Real> load_line(int id, const Index3& first, int along, bool in_columns) const {
    if (!in_columns) return Layout::load_line(block(id), first, along);
    const auto [x, y, z] = first;
    return along == 1 ? Layout::load_row(column(id, x, z)) : Layout::load_column(column(id, x, 0), y, 0, 1);
  }

  /// The same of a row, or of columns.
  void store_line(int id, const Index3& first, int along, const Row<Real>& line) {
    const auto [x, y, z] = first;
    if (along == 0) return Layout::store_row(row(id, y, z), line);
    if (along == 1) return Layout::store_row(column(id, x, z), line);
    Layout::store_column(column(id, x, 0), y, 0, 1, line);
  }

  /// Adds to density or velocity of one cell of a leaf; returns by how much it changed, which rounding decides.
  double add(int id, const Index3& cell, int m, Real value) {
    changed_[id] = true;
    const auto [x, y, z] = cell;
    Real& sum = Layout::macro(row(id, y, z), m)[x];
    const Real before = sum;
    sum += value;
    if (x == 0 || x == amr::block_size - 1) Layout::macro(column(id, x, z), m)[y] = sum;
    return double{sum} - double{before};
  }

  /// The same for a line of 16 cells at a face of a leaf, 0 to 5: number `r` of the columns at an x face, of the rows
  /// at the others. Returns the sum of the changes.
  double add_at_face(int id, int face, int r, int m, Real value) {
    changed_[id] = true;
    const int axis = face / 2, layer = face & 1 ? amr::block_size - 1 : 0;
    const int y = axis == 1 ? layer : r, z = axis == 2 ? layer : r;
    Real* cell = Layout::macro(line(id, axis, layer, r), m);
    double sum = 0.0;
    for (int i = 0; i < lanes; ++i) {
      const Real before = cell[i];
      cell[i] += value;
      sum += double{cell[i]} - double{before};
    }
    if (axis == 0)
      for (int i = 0; i < lanes; ++i) Layout::macro(row(id, i, z), m)[layer] = cell[i];
    else
      for (const int x : {0, amr::block_size - 1}) Layout::macro(column(id, x, z), m)[y] = cell[x];
    return sum;
  }

  void refresh_columns(int id) {
    changed_[id] = true;
    for (const int x : {0, amr::block_size - 1})
      for (int z = 0; z < amr::block_size; ++z)
        Layout::store_row(column(id, x, z), Layout::load_column(block(id), x, z * amr::block_size, 1));
  }

  /// The same where only the velocity of one row has changed.
  void velocity_to_columns(int id, int y, int z) {
    changed_[id] = true;
    for (const int x : {0, amr::block_size - 1})
      for (const Moment m : {ux, uy, uz}) Layout::macro(column(id, x, z), m)[y] = Layout::macro(row(id, y, z), m)[x];
  }

  /// Whether one of the four above has been called since forget_changes().
  bool changed(int id) const { return changed_[id]; }
  void forget_changes(int id) { changed_[id] = false; }

 private:
  HugeArray rows_, columns_;
  std::vector<std::uint8_t> changed_;  // of each block
};

}  // namespace drogue::lbm
