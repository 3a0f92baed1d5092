// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernels of all families share. A kernel computes as many elements at a time as a pack has lanes; a family is
// a batch type and these functions of it, with the law of the material as a template parameter:
//   prepare_geometry   reference geometry; of an inverted or flat element some weight is not positive
//   nodal_forces       minus the gradient of the energy, with the active stress; and the range of the volume ratio
//   add_tangent        adds minus the derivative of nodal_forces with the positions to a matrix
//   energy             of each element [J]
//   volume_ratio       its range over the Gauss points
//   lump_volumes       reference volume on the nodes [m^3]
//   directional_stiffness   largest eigenvalue [Pa/m^2] of the acoustic tensor at the centre for each of up to three
//                      directions, from above, such that their sum bounds density times squared frequency of an element
//                      with its mass lumped equally on its nodes
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/types.hpp"
#include "fem/simd_math.hpp"

namespace drogue::fem {

/// Of N nodes, lane by lane.
template <std::size_t N>
using BatchNodes = std::array<std::array<int, lanes>, N>;

template <std::size_t N>
struct NodalForces {
  Pack component[N][3];  ///< [local node][axis] [N]
};

template <std::size_t N>
struct Stiffness {
  Pack component[N][3][N][3];  ///< [node of the force][axis][node that moves][axis] [N/m]
};

/// Smallest and largest volume ratio J, lane by lane.
struct VolumeRatio {
  Pack smallest = splat<Pack>(INFINITY), largest = splat<Pack>(-INFINITY);

  void extend(const Pack& j) {
    // Ordered so that a NaN replaces the range: a position that is none makes J NaN at every point.
    smallest = smallest < j ? smallest : j;
    largest = largest > j ? largest : j;
  }
};

template <std::size_t... lane>
inline Pack gather(const std::array<int, lanes>& node, const Vec3* x, int axis, std::index_sequence<lane...>) {
  return Pack{x[node[lane]][axis]...};
}

/// Of the present time, see ActiveStress.
struct ActiveFibre {
  double tension = 0.0;  ///< [Pa]
  Vec3 direction = Vec3::UnitX();
};

/// Component `axis` of the field `x` at a node of each lane.
inline Pack gather(const std::array<int, lanes>& node, std::span<const Vec3> x, int axis) {
  return gather(node, x.data(), axis, std::make_index_sequence<lanes>{});
}

}  // namespace drogue::fem
