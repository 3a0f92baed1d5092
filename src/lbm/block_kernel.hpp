// SPDX-License-Identifier: GPL-3.0-or-later
// Block kernel: reconstruct post-collision populations of a source row in registers, stream them into rolling scratch
// that fits the first-level cache, and take the moments of a target row as soon as it is complete (one plane and one
// row behind). Source rows run from -1 to 16 in y and z; of a row outside the block only what enters it is built: five
// populations cross a face, one an edge, none a corner. What enters through the two x faces is built for whole columns
// along y.
#pragma once

#include <algorithm>

#include "core/error.hpp"
#include "lbm/d3q19.hpp"
#include "lbm/eddy_viscosity.hpp"
#include "lbm/stream_collide.hpp"

namespace drogue::lbm {

template <class S, fluid::Collision collision, fluid::EddyViscosity eddy>
class BlockKernel {
 public:
  using Layout = RowLayout<S>;
  using Real = typename S::Real;
  using V = Vec<Real>;
  using Series = HermiteSeries<V, collision != fluid::Collision::bgk>;

  BlockKernel(const BlockNeighbourhood<S>& blocks, const Relaxation& relaxation)
      : blocks_(blocks),
        tau_(static_cast<Real>(relaxation.tau)),
        keep_(static_cast<Real>(1.0 - 1.0 / relaxation.tau)),
        per_keep_(Real(1) / keep_),
        sigma_(static_cast<Real>(relaxation.sigma)),
        strain_factor_((sigma_ - Real(1)) / 3),
        dispersion_(static_cast<Real>(std::max(0.0, relaxation.tau * (3 - 4 * relaxation.tau) / 6))),
        eddy_factor_(static_cast<Real>(relaxation.eddy_factor)),
        kick_{static_cast<Real>(relaxation.kick[0]), static_cast<Real>(relaxation.kick[1]),
              static_cast<Real>(relaxation.kick[2])} {}

  BlockRecord run() {
    build_edge_columns();
    source_plane<-1>(-1);
    for (int z = 0; z < n; ++z) source_plane<0>(z);
    source_plane<1>(n);
    return record();
  }

 private:
  static constexpr int n = amr::block_size;

  /// Streamed populations of target rows, already shifted in x. Index of a population: (cy + 1) * 3 + (cx + 1).
  struct alignas(sizeof(V)) Scratch {
    Real level[2][n][9][lanes];  // c_z = 0, by parity of the target plane
    Real up[3][n][9][lanes];     // c_z = +1, by target plane modulo 3 (five of nine used)
    Real down[4][9][lanes];      // c_z = -1, by target row modulo 4
  };

  /// What enters through the two x faces from the source plane at hand, and the velocity beyond them.
  struct alignas(sizeof(V)) XHalo {
    Real entering[2][3][3][32];     // [side][cy + 1][cz + 1][y + 1]
    Real velocity[2][2][3][lanes];  // [parity of plane][side][component][y]
  };

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
        const std::byte* columns = blocks_.columns[slot];
        const int y = above ? 0 : n - 1;
        const Series g((columns ? Layout::load_column(columns, y, side ? 0 : n, 1)
                                : Layout::load_column(blocks_.source[slot], side ? 0 : n - 1, y, n))
                           .m,
                       keep_);
        const V v = side ? (above ? g.template population<-1, -1, 0>() : g.template population<-1, 1, 0>())
                         : (above ? g.template population<1, -1, 0>() : g.template population<1, 1, 0>());
        store<Real>(edge_[side][above], v);
      }
  }

  template <int Z, int cx>
  void enter_from(int side, const Row<Real>& column) {
    const Series g(column.m, keep_);
    auto& to = halo_.entering[side];
    if constexpr (enters<0, Z>(0, 0)) {
      store_unaligned<Real>(to[1][1] + 1, g.template population<cx, 0, 0>());
      store_unaligned<Real>(to[0][1] + 1, g.template population<cx, -1, 0>());
      store_unaligned<Real>(to[2][1] + 1, g.template population<cx, 1, 0>());
    }
    if constexpr (enters<0, Z>(0, -1)) store_unaligned<Real>(to[1][0] + 1, g.template population<cx, 0, -1>());
    if constexpr (enters<0, Z>(0, 1)) store_unaligned<Real>(to[1][2] + 1, g.template population<cx, 0, 1>());
  }

  template <int Z>
  void build_x_halo(int z) {
    for (int side = 0; side < 2; ++side) {
      const int slot = amr::neighbour_slot(side ? 1 : -1, 0, Z), plane = z & (n - 1);
      const std::byte* columns = blocks_.columns[slot];
      const Row<Real> column = columns ? Layout::load_row(columns + ((side ? 0 : n) + plane) * Layout::bytes)
                                       : Layout::load_column(blocks_.source[slot], side ? 0 : n - 1, plane * n, 1);
      if (side)
        enter_from<Z, -1>(side, column);
      else
        enter_from<Z, 1>(side, column);
      if constexpr (Z == 0) {
        for (int a = 0; a < 3; ++a) store<Real>(halo_.velocity[z & 1][side][a], column.m[ux + a]);
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
    if (y < 6) {  // columns: the x faces and the four x-y edges
      const int dx = y % 2 ? 1 : -1, dy = y < 2 ? 0 : y < 4 ? -1 : 1;
      const std::byte* columns = blocks_.next->columns[amr::neighbour_slot(dx, dy, 0)];
      if (columns) prefetch_row(columns + ((dx > 0 ? 0 : n) + z) * Layout::bytes);
    }
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

  /// Builds the populations of one source row and streams them. Flattened, like target_row(): GCC 12 would call what is
  /// in here and pass dozens of vectors through memory, which takes 1.5 times as long.
  template <int Y, int Z>
  [[gnu::flatten]] void source_row(int y, int z) {
    const Series g(Layout::load_row(row(y, z)).m, keep_);
    stream<-1, Y, Z>(g, y, z);
    stream<0, Y, Z>(g, y, z);
    stream<1, Y, Z>(g, y, z);
  }

  /// All populations of one c_z.
  template <int cz, int Y, int Z>
  void stream(const Series& g, int y, int z) {
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
  void put(const Series& g, int y, int z) {
    if constexpr (in_lattice(cx, cy, cz) && enters<Y, Z>(cy, cz)) {
      const int ty = y + cy, tz = z + cz;
      if constexpr (Y == 0 && cy != 0) {
        if (ty < 0 || ty >= n) return;
      }
      if constexpr (Z == 0 && cz != 0) {
        if (tz < 0 || tz >= n) return;
      }
      V v = g.template population<cx, cy, cz>();
      if constexpr (cx == 1) v = shift_up<Real>(v, halo_.entering[0][cy + 1][cz + 1][y + 1]);
      if constexpr (cx == -1) v = shift_down<Real>(v, halo_.entering[1][cy + 1][cz + 1][y + 1]);
      store<Real>(slot<cz>(ty, tz)[(cy + 1) * 3 + cx + 1], v);
    }
  }

  template <int cz>
  Real (*slot(int ty, int tz))[lanes] {
    if constexpr (cz == 0) return scratch_.level[tz & 1][ty];
    if constexpr (cz == 1) return scratch_.up[tz % 3][ty];
    return scratch_.down[ty & 3];
  }

  /// The populations of a complete target row.
  struct Streamed {
    const Real (*level)[lanes];
    const Real (*up)[lanes];
    const Real (*down)[lanes];

    template <int cx, int cy, int cz>
    V get() const {
      const auto from = cz == 0 ? level : cz == 1 ? up : down;
      return load<Real>(from[(cy + 1) * 3 + cx + 1]);
    }
  };

  [[gnu::flatten]] void target_row(int y, int z) {
    const Hybrid hybrid = collision == fluid::Collision::hrr ? hybrid_at(y, z) : Hybrid{};
    Row<Real> r;
    r.m = moments_of<V>(Streamed{slot<0>(y, z), slot<1>(y, z), slot<-1>(y, z)});
    watch(r);
    if constexpr (collision == fluid::Collision::hrr) hybrid.apply(r);
    for (int a = 0; a < 3; ++a) r.m[ux + a] += kick_[a];
    store_target(blocks_.target + (z * n + y) * Layout::bytes, r);
    publish(r, y, z);
  }

  void store_target(std::byte* to, const Row<Real>& r) const {
    if (blocks_.past_caches)
      Layout::store_row_streaming(to, r);
    else
      Layout::store_row(to, r);
  }

  /// The hybrid term: Pneq <- kept Pneq + rho estimate.
  struct Hybrid {
    V kept;
    std::array<V, 6> estimate;  // in the order of the moments

    void apply(Row<Real>& r) const {
      const V rho = Real(1) + r.m[drho];
      for (int i = 0; i < 6; ++i) r.m[pxx + i] = kept * r.m[pxx + i] + rho * estimate[i];
    }
  };

  /// Central differences of the velocity one step ago.
  struct Differences {
    Gradient<V> twice_gradient;
    std::array<V, 3> curvature;  // along each axis, of the product of the two other components
  };

  /// One axis is done with before the next is loaded, or GCC 12 runs out of registers and takes 8 % longer.
  Differences differences(int y, int z) const {
    const std::byte* here = row(y, z);
    const auto& beyond = halo_.velocity[z & 1];
    std::array<V, 3> u, next, previous;
    for (int a = 0; a < 3; ++a) u[a] = load(Layout::macro(here, ux + a));
    Differences d;
    for (int axis = 0; axis < 3; ++axis) {
      const std::byte* after = axis == 1 ? row(y + 1, z) : row(y, z + 1);
      const std::byte* before = axis == 1 ? row(y - 1, z) : row(y, z - 1);
      for (int a = 0; a < 3; ++a) {
        next[a] = axis == 0 ? shift_down<Real>(u[a], beyond[1][a][y]) : load(Layout::macro(after, ux + a));
        previous[a] = axis == 0 ? shift_up<Real>(u[a], beyond[0][a][y]) : load(Layout::macro(before, ux + a));
        d.twice_gradient[axis][a] = next[a] - previous[a];
      }
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      d.curvature[axis] = (next[a] * next[b] + previous[a] * previous[b]) - Real(2) * (u[a] * u[b]);
    }
    return d;
  }

  /// The estimate is factor 2 S, from central differences of the velocity one step ago (its rim is there, a wider one
  /// is not needed), and in the shear stresses what cancels the lattice's dispersion (docs/theory.md, Dispersion). An
  /// eddy viscosity acts through the stress that is stored, scaled so that the relaxation time of the level turns it
  /// into the one after a collision with tau + 3 nu_t: (1 - 1/tau) P' = (1 - 1/tau_t) P. All this comes before the row
  /// itself is collected: it is a long chain of operations, which the processor overlaps with the sums.
  Hybrid hybrid_at(int y, int z) const {
    const auto [d, curvature] = differences(y, z);
    V kept = broadcast(sigma_), factor = broadcast(strain_factor_ * tau_);
    if constexpr (eddy != fluid::EddyViscosity::none) {
      const V tau = tau_ + Real(1.5) * eddy_viscosity<eddy, V>(d, eddy_factor_);
      const V scale = per_keep_ - per_keep_ * reciprocal(tau);
      kept = sigma_ * scale;
      factor = strain_factor_ * (scale * tau);
    }
    const V shear = Real(0.5) * factor;
    // beyond tau = 3/4 nothing is cancelled, and at 1 per_keep_ is infinite
    const V streamed = dispersion_ > Real(0) ? dispersion_ * (kept - per_keep_) : V{};
    return {
        kept,
        {factor * d[0][0], factor * d[1][1], factor * d[2][2], shear * (d[0][1] + d[1][0]) + streamed * curvature[2],
         shear * (d[0][2] + d[2][0]) + streamed * curvature[1], shear * (d[1][2] + d[2][1]) + streamed * curvature[0]}};
  }

  /// Collects the cells at the x faces; a complete plane becomes the columns that neighbours will read.
  void publish(const Row<Real>& r, int y, int z) {
    for (int m = 0; m < moments; ++m) {
      published_[0][m][y] = r.m[m][0];
      published_[1][m][y] = r.m[m][lanes - 1];
    }
    if (blocks_.sums && blocks_.sums->wants(y, z)) blocks_.sums->add(r, y, z);
    if (y < n - 1) return;
    for (int side = 0; side < 2; ++side) {
      Row<Real> column;
      for (int m = 0; m < moments; ++m) column.m[m] = load<Real>(published_[side][m]);
      store_target(blocks_.target_columns + (side * n + z) * Layout::bytes, column);
    }
  }

  void watch(const Row<Real>& r) {
    const V speed = r.m[ux] * r.m[ux] + r.m[uy] * r.m[uy] + r.m[uz] * r.m[uz];
    max_speed_ = maximum(max_speed_, speed);
    const V compression = r.m[drho] * r.m[drho];
    // a comparison that a NaN fails
    in_bounds_ &= (speed < speed_limit * speed_limit) & (compression < density_limit * density_limit);
  }

  BlockRecord record() const {
    BlockRecord result;
    for (int i = 0; i < lanes; ++i) {
      result.max_speed_squared = std::max(result.max_speed_squared, static_cast<float>(max_speed_[i]));
      result.diverged |= in_bounds_[i] == 0;
    }
    return result;
  }

  const BlockNeighbourhood<S>& blocks_;
  const Real tau_, keep_, per_keep_, sigma_, strain_factor_, dispersion_, eddy_factor_;
  const std::array<Real, 3> kick_;
  V max_speed_{};
  IndexVec<Real> in_bounds_ = IndexVec<Real>{} - 1;
  alignas(sizeof(V)) Real edge_[2][2][lanes];             // [x side][y side][z]
  alignas(sizeof(V)) Real published_[2][moments][lanes];  // [x side][moment][y]
  XHalo halo_;
  Scratch scratch_;
};

template <class S, fluid::Collision collision, fluid::EddyViscosity eddy = fluid::EddyViscosity::none>
BlockRecord update_block(const BlockNeighbourhood<S>& blocks, const Relaxation& relaxation) {
  return BlockKernel<S, collision, eddy>(blocks, relaxation).run();
}

template <class S>
BlockUpdate<S> block_update(fluid::Collision collision, fluid::EddyViscosity eddy) {
  using fluid::Collision, fluid::EddyViscosity;
  if (collision != Collision::hrr && eddy != EddyViscosity::none)
    throw InputError("an eddy viscosity needs the velocity gradients of the hrr collision");
  if (collision == Collision::bgk) return update_block<S, Collision::bgk>;
  if (collision == Collision::rr) return update_block<S, Collision::rr>;
  switch (eddy) {
    case EddyViscosity::none:
      return update_block<S, Collision::hrr>;
    case EddyViscosity::vreman:
      return update_block<S, Collision::hrr, EddyViscosity::vreman>;
    case EddyViscosity::wale:
      return update_block<S, Collision::hrr, EddyViscosity::wale>;
    case EddyViscosity::smagorinsky:
      return update_block<S, Collision::hrr, EddyViscosity::smagorinsky>;
  }
  return nullptr;
}

}  // namespace drogue::lbm
