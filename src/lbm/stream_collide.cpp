// SPDX-License-Identifier: GPL-3.0-or-later
// Block kernel: reconstruct post-collision populations of a source row in registers, stream them into rolling scratch
// that fits the first-level cache, and take the moments of a target row as soon as it is complete (one plane and one
// row behind). Source rows run from -1 to 16 in y and z; of a row outside the block only what enters it is built: five
// populations cross a face, one an edge, none a corner. What enters through the two x faces is built for whole columns
// along y.
#include "lbm/stream_collide.hpp"

#include <algorithm>

#include "lbm/d3q19.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

/// Streamed populations of target rows, already shifted in x. Index of a population: (cy + 1) * 3 + (cx + 1).
struct alignas(64) Scratch {
  float level[2][n][9][lanes];  // c_z = 0, by parity of the target plane
  float up[3][n][9][lanes];     // c_z = +1, by target plane modulo 3 (five of nine used)
  float down[4][9][lanes];      // c_z = -1, by target row modulo 4
};

/// What enters through the two x faces from the source plane at hand, and the velocity beyond them.
struct alignas(64) XHalo {
  float entering[2][3][3][32];     // [side][cy + 1][cz + 1][y + 1]
  float velocity[2][2][3][lanes];  // [parity of plane][side][component][y]
};

template <class S>
class Kernel {
 public:
  using Layout = RowLayout<S>;

  Kernel(const BlockNeighbourhood<S>& blocks, const Relaxation& relaxation)
      : blocks_(blocks),
        keep_(1.0f - 1.0f / relaxation.tau),
        sigma_(relaxation.sigma),
        strain_factor_(-(1.0f - relaxation.sigma) * relaxation.tau / 3.0f) {}

  BlockRecord run() {
    build_edge_columns();
    source_plane<-1>(-1);
    for (int z = 0; z < n; ++z) source_plane<0>(z);
    source_plane<1>(n);
    return record();
  }

 private:
  const std::byte* row(int y, int z) const {
    const int dy = (y >= n) - (y < 0), dz = (z >= n) - (z < 0);
    return blocks_.source[amr::neighbour_slot(0, dy, dz)] + ((z & (n - 1)) * n + (y & (n - 1))) * Layout::bytes;
  }

  /// Is a population of this (cy, cz) wanted from a source row on side Y, Z (-1 below, 0 inside, +1 above the block)?
  template <int Y, int Z>
  static constexpr bool enters(int cy, int cz) {
    return (Y == 0 || cy == -Y) && (Z == 0 || cz == -Z);
  }

  /// The populations that enter through the four x-y edges, for all z: (c_x, c_y, 0) from the diagonal neighbours.
  void build_edge_columns() {
    for (int side = 0; side < 2; ++side)
      for (int above = 0; above < 2; ++above) {
        const int slot = amr::neighbour_slot(side ? 1 : -1, above ? 1 : -1, 0);
        const HermiteSeries<Vec> g(Layout::load_column(blocks_.source[slot], side ? 0 : n - 1, above ? 0 : n - 1, n).m,
                                   keep_);
        const Vec v = side ? (above ? g.population<-1, -1, 0>() : g.population<-1, 1, 0>())
                           : (above ? g.population<1, -1, 0>() : g.population<1, 1, 0>());
        store(edge_[side][above], v);
      }
  }

  template <int Z, int cx>
  void enter_from(int side, const Row& column) {
    const HermiteSeries<Vec> g(column.m, keep_);
    auto& to = halo_.entering[side];
    if constexpr (enters<0, Z>(0, 0)) {
      store_unaligned(to[1][1] + 1, g.template population<cx, 0, 0>());
      store_unaligned(to[0][1] + 1, g.template population<cx, -1, 0>());
      store_unaligned(to[2][1] + 1, g.template population<cx, 1, 0>());
    }
    if constexpr (enters<0, Z>(0, -1)) store_unaligned(to[1][0] + 1, g.template population<cx, 0, -1>());
    if constexpr (enters<0, Z>(0, 1)) store_unaligned(to[1][2] + 1, g.template population<cx, 0, 1>());
  }

  template <int Z>
  void build_x_halo(int z) {
    for (int side = 0; side < 2; ++side) {
      const std::byte* neighbour = blocks_.source[amr::neighbour_slot(side ? 1 : -1, 0, Z)];
      const Row column = Layout::load_column(neighbour, side ? 0 : n - 1, (z & (n - 1)) * n, 1);
      if (side)
        enter_from<Z, -1>(side, column);
      else
        enter_from<Z, 1>(side, column);
      if constexpr (Z == 0) {
        for (int a = 0; a < 3; ++a) store(halo_.velocity[z & 1][side][a], column.m[ux + a]);
        halo_.entering[side][2][1][0] = edge_[side][0][z];
        halo_.entering[side][0][1][n + 1] = edge_[side][1][z];
      }
    }
  }

  /// Row (y, z) of the next block, and in turn one of the rows around it: software has to do it, the hardware's
  /// prefetcher sees no stream in these rows. Forced inline, or GCC 12 drops calls to a function without effects.
  [[gnu::always_inline]] inline void prefetch_next(int y, int z) const {
    if (!blocks_.next) return;
    const auto& source = blocks_.next->source;
    prefetch_row(source[amr::neighbour_slot(0, 0, 0)] + (z * n + y) * Layout::bytes);
    if (y == 0) prefetch_row(source[amr::neighbour_slot(0, -1, 0)] + (z * n + n - 1) * Layout::bytes);
    if (y == n - 1) prefetch_row(source[amr::neighbour_slot(0, 1, 0)] + z * n * Layout::bytes);
    if (z == 0) prefetch_row(source[amr::neighbour_slot(0, 0, -1)] + ((n - 1) * n + y) * Layout::bytes);
    if (z == n - 1) prefetch_row(source[amr::neighbour_slot(0, 0, 1)] + y * Layout::bytes);
    // of the rows beyond the x faces the lines that hold the last or the first cells
    prefetch_row(source[amr::neighbour_slot(-1, 0, 0)] + (z * n + y) * Layout::bytes);
    prefetch_row(source[amr::neighbour_slot(1, 0, 0)] + (z * n + y) * Layout::bytes);
  }

  [[gnu::always_inline]] static inline void prefetch_row(const std::byte* p) {
    for (std::size_t line = 0; line < Layout::bytes; line += 64) __builtin_prefetch(p + line, 0, 2);
  }

  template <int Z>
  void source_plane(int z) {
    build_x_halo<Z>(z);
    source_row<-1, Z>(-1, z);
    source_row<0, Z>(0, z);
    if constexpr (Z == 0) prefetch_next(0, z);
    for (int y = 1; y < n; ++y) {
      source_row<0, Z>(y, z);
      if constexpr (Z == 0) prefetch_next(y, z);
      if (z > 0) target_row(y - 1, z - 1);
    }
    source_row<1, Z>(n, z);
    if (z > 0) target_row(n - 1, z - 1);
  }

  /// Builds the populations of one source row and streams them.
  template <int Y, int Z>
  void source_row(int y, int z) {
    const HermiteSeries<Vec> g(Layout::load_row(row(y, z)).m, keep_);
    stream<-1, Y, Z>(g, y, z);
    stream<0, Y, Z>(g, y, z);
    stream<1, Y, Z>(g, y, z);
  }

  /// All populations of one c_z.
  template <int cz, int Y, int Z>
  void stream(const HermiteSeries<Vec>& g, int y, int z) {
    put<-1, -1, cz, Y, Z>(g, y, z);
    put<0, -1, cz, Y, Z>(g, y, z);
    put<1, -1, cz, Y, Z>(g, y, z);
    put<-1, 0, cz, Y, Z>(g, y, z);
    put<0, 0, cz, Y, Z>(g, y, z);
    put<1, 0, cz, Y, Z>(g, y, z);
    put<-1, 1, cz, Y, Z>(g, y, z);
    put<0, 1, cz, Y, Z>(g, y, z);
    put<1, 1, cz, Y, Z>(g, y, z);
  }

  template <int cx, int cy, int cz, int Y, int Z>
  void put(const HermiteSeries<Vec>& g, int y, int z) {
    if constexpr (in_lattice(cx, cy, cz) && enters<Y, Z>(cy, cz)) {
      const int ty = y + cy, tz = z + cz;
      if constexpr (Y == 0 && cy != 0) {
        if (ty < 0 || ty >= n) return;
      }
      if constexpr (Z == 0 && cz != 0) {
        if (tz < 0 || tz >= n) return;
      }
      Vec v = g.template population<cx, cy, cz>();
      if constexpr (cx == 1) v = shift_up(v, halo_.entering[0][cy + 1][cz + 1][y + 1]);
      if constexpr (cx == -1) v = shift_down(v, halo_.entering[1][cy + 1][cz + 1][y + 1]);
      store(slot<cz>(ty, tz)[(cy + 1) * 3 + cx + 1], v);
    }
  }

  template <int cz>
  float (*slot(int ty, int tz))[lanes] {
    if constexpr (cz == 0) return scratch_.level[tz & 1][ty];
    if constexpr (cz == 1) return scratch_.up[tz % 3][ty];
    return scratch_.down[ty & 3];
  }

  /// The populations of a complete target row.
  struct Streamed {
    const float (*level)[lanes];
    const float (*up)[lanes];
    const float (*down)[lanes];

    template <int cx, int cy, int cz>
    Vec get() const {
      const auto from = cz == 0 ? level : cz == 1 ? up : down;
      return load(from[(cy + 1) * 3 + cx + 1]);
    }
  };

  void target_row(int y, int z) {
    Row r;
    r.m = moments_of<Vec>(Streamed{slot<0>(y, z), slot<1>(y, z), slot<-1>(y, z)});
    watch(r);
    if (sigma_ < 1.0f) blend_strain(r, y, z);
    store_row(blocks_.target + (z * n + y) * Layout::bytes, r);
  }

  /// Hybrid term, from central differences of the velocity one step ago (its rim is there, a wider one is not needed).
  void blend_strain(Row& r, int y, int z) {
    const std::byte *here = row(y, z), *south = row(y - 1, z), *north = row(y + 1, z);
    const std::byte *below = row(y, z - 1), *above = row(y, z + 1);
    std::array<std::array<Vec, 3>, 3> d;  // twice the derivative [along][component]
    for (int a = 0; a < 3; ++a) {
      const Vec u = load(Layout::macro(here, ux + a));
      const auto& beyond = halo_.velocity[z & 1];
      d[0][a] = shift_down(u, beyond[1][a][y]) - shift_up(u, beyond[0][a][y]);
      d[1][a] = load(Layout::macro(north, ux + a)) - load(Layout::macro(south, ux + a));
      d[2][a] = load(Layout::macro(above, ux + a)) - load(Layout::macro(below, ux + a));
    }
    const Vec normal = strain_factor_ * (1.0f + r.m[drho]);
    const Vec shear = 0.5f * normal;
    r.m[pxx] = sigma_ * r.m[pxx] + normal * d[0][0];
    r.m[pyy] = sigma_ * r.m[pyy] + normal * d[1][1];
    r.m[pzz] = sigma_ * r.m[pzz] + normal * d[2][2];
    r.m[pxy] = sigma_ * r.m[pxy] + shear * (d[0][1] + d[1][0]);
    r.m[pxz] = sigma_ * r.m[pxz] + shear * (d[0][2] + d[2][0]);
    r.m[pyz] = sigma_ * r.m[pyz] + shear * (d[1][2] + d[2][1]);
  }

  static void store_row(std::byte* to, const Row& r) {
    for (int m = 0; m < 4; ++m) store_streaming(Layout::macro(to, m), r.m[m]);
    for (int m = 4; m < moments; ++m) S::store_streaming(Layout::stress(to, m), r.m[m]);
  }

  void watch(const Row& r) {
    const Vec speed = r.m[ux] * r.m[ux] + r.m[uy] * r.m[uy] + r.m[uz] * r.m[uz];
    max_speed_ = maximum(max_speed_, speed);
    const Vec compression = r.m[drho] * r.m[drho];
    // a comparison that a NaN fails
    in_bounds_ &= (speed < speed_limit * speed_limit) & (compression < density_limit * density_limit);
  }

  BlockRecord record() const {
    BlockRecord result;
    for (int i = 0; i < lanes; ++i) {
      result.max_speed_squared = std::max(result.max_speed_squared, max_speed_[i]);
      result.diverged |= in_bounds_[i] == 0;
    }
    return result;
  }

  const BlockNeighbourhood<S>& blocks_;
  const float keep_, sigma_, strain_factor_;
  Vec max_speed_{};
  Ivec in_bounds_ = Ivec{} - 1;
  alignas(64) float edge_[2][2][lanes];  // [x side][y side][z]
  XHalo halo_;
  Scratch scratch_;
};

}  // namespace

template <class S>
BlockRecord stream_collide(const BlockNeighbourhood<S>& blocks, const Relaxation& relaxation) {
  return Kernel<S>(blocks, relaxation).run();
}

#ifdef __F16C__
template BlockRecord stream_collide(const BlockNeighbourhood<HalfStress>&, const Relaxation&);
#endif
template BlockRecord stream_collide(const BlockNeighbourhood<FloatStress>&, const Relaxation&);

}  // namespace drogue::lbm
