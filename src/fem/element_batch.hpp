// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernels of all families share. A kernel computes as many elements at a time as a pack has lanes; a family is
// a batch type and these functions of it, with the law of the material as a template parameter:
//   prepare_geometry   reference geometry; of an inverted or flat element some weight is not positive
//   nodal_forces       minus the gradient of the energy, with the active stress; and the range of the volume ratio
//   add_tangent        adds minus the derivative of nodal_forces with the positions to a matrix
//   energy             of each element [J]
//   volume_ratio       its range over the Gauss points
//   lump_volumes       reference volume on the nodes [m^3]
//   directional_stiffness   norms [Pa/m^2], from above, of the blocks of the acoustic tensor at the centre between up
//   to
//                      three directions: a symmetric matrix whose largest eigenvalue bounds density times squared
//                      frequency of an element with its mass lumped equally on its nodes
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/types.hpp"
#include "fem/simd_math.hpp"
#include "fem/tensor.hpp"

namespace drogue::fem {

/// Upper bound of the largest eigenvalue of a symmetric tensor: mean + 2 sqrt(p), p = |q - mean|^2 / 6. Exact if the
/// two others are equal, as those of the acoustic tensor of an isotropic solid are; at most 4/3 of it for a positive
/// one.
inline Pack largest_eigenvalue_bound(const Tensor<Pack>& q) {
  const Pack mean = (1.0 / 3.0) * trace(q);
  const Pack deviation = larger(dot(q, q) - 3.0 * mean * mean, Pack{});
  return mean + 2.0 * square_root(deviation * (1.0 / 6.0));
}

/// Directional stiffness of which only the blocks on the diagonal are known: those of a positive tensor have norms
/// |A_IJ|^2 <= |A_II| |A_JJ|.
inline Tensor<Pack> directional_stiffness_of(const std::array<Pack, 3>& diagonal) {
  return tensor<Pack>([&](int i, int j) { return i == j ? diagonal[i] : square_root(diagonal[i] * diagonal[j]); });
}

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
