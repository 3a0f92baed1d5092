// SPDX-License-Identifier: GPL-3.0-or-later
// How the transfer between levels cuts up the rim of a block: into layers, a layer into lines of 16 cells whose ten
// moments are adjacent. Next to a y or z face lines are rows; next to an x face they are columns along y, so that no
// face is more expensive than another.
#pragma once

#include <algorithm>
#include <array>

#include "lbm/moments.hpp"
#include "lbm/stencils.hpp"

namespace drogue::lbm {

/// Of lines normal to an axis: the axis across them, in a layer, and the one along them.
constexpr int across_axis(int normal) { return normal == 2 ? 1 : 2; }
constexpr int along_axis(int normal) { return normal == 0 ? 1 : 0; }

/// Half-open.
struct Range {
  int begin, end;
};

/// Copies cells `along` of a line that has been written to where else they are kept: the ends of a row to columns, a
/// column to rows.
template <class S>
void copy_line(MomentField<S>& field, int id, int normal, int layer, int across, const Range& along) {
  using Layout = RowLayout<S>;
  if (normal > 0) {
    const int y = normal == 1 ? layer : across, z = normal == 1 ? across : layer;
    for (const int x : {0, amr::block_size - 1})
      if (x >= along.begin && x < along.end) Layout::copy_element(field.row(id, y, z), x, field.column(id, x, z), y);
  } else {
    for (int y = along.begin; y < along.end; ++y)
      Layout::copy_element(field.column(id, layer, across), y, field.row(id, y, across), layer);
  }
}

/// What differs between the states of two levels.
struct Conversion {
  double stress_factor = 1.0;          ///< of the stress, which scales with tau and the time step
  Vec3 velocity_shift = Vec3::Zero();  ///< added to the velocity, lattice units (lbm/body_force.cpp)
};

/// The same by moment, of a sum whose weights add up to `total`: m becomes factor[m] m + shift[m].
template <class Real>
struct MomentConversion {
  std::array<Real, moments> factor, shift;

  explicit MomentConversion(const Conversion& c, Real total = 1) {
    for (int m = 0; m < moments; ++m) {
      factor[m] = static_cast<Real>(m < pxx ? 1.0 : c.stress_factor);
      shift[m] = m >= ux && m <= uz ? total * static_cast<Real>(c.velocity_shift[m - ux]) : Real(0);
    }
  }
};

/// Whether levels differ in a moment by its curvature along an axis: every stress but for one axis each
/// (docs/theory.md, Levels).
constexpr bool is_curved(int m, int axis) {
  constexpr std::array<int, 6> but_for{0, 1, 2, 2, 1, 0};
  return m >= pxx && but_for[m - pxx] != axis;
}

/// Weights along an axis, to be asked with is_curved() of a moment.
template <class Real>
using MomentWeights = std::array<std::array<Real, Axis::most_taps>, 2>;

/// The value, and to what is curved `share` of the curvature added.
template <class Real>
MomentWeights<Real> moment_weights(const Axis::Weights& value, const Axis::Weights& curvature, double share) {
  MomentWeights<Real> w;
  for (int k = 0; k < Axis::most_taps; ++k) {
    w[false][k] = static_cast<Real>(value[k]);
    w[true][k] = static_cast<Real>(value[k] + share * curvature[k]);
  }
  return w;
}

/// An axis in the precision of the state, with lane numbers for lines that are combined along themselves.
template <class Real>
struct Stencil {
  std::array<int, amr::block_size> start;
  std::array<MomentWeights<Real>, amr::block_size> weight;
  std::array<IndexVec<Real>, Axis::most_taps> lane;
  std::array<std::array<Vec<Real>, Axis::most_taps>, 2> lane_weight;

  Stencil(const Axis& axis, double curvature) : start(axis.start) {
    for (int i = 0; i < amr::block_size; ++i) {
      weight[i] = moment_weights<Real>(axis.weight[i], axis.curvature[i], curvature);
      for (int k = 0; k < Axis::most_taps; ++k) {
        for (const bool curved : {false, true}) lane_weight[curved][k][i] = weight[i][curved][k];
        lane[k][i] = std::min(axis.start[i] + k, 2 * amr::block_size - 1);
      }
    }
  }
};

}  // namespace drogue::lbm
