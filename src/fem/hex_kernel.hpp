// SPDX-License-Identifier: GPL-3.0-or-later
// Trilinear hexahedra, as many at a time as a pack has lanes: forces, energy, volume ratio and stable step.
//
// In the parent cube [-1, 1]^3 a derivative along xi depends on eta and zeta alone, so each of the three columns of
// D = dx/dxi takes four values at the 2x2x2 Gauss points, interpolated from the four edges along xi. Hence
// F = D A with the stored A = (dX/dxi)^{-1}, and the forces are the transposed interpolation of w P A^T, w = det
// dX/dxi. That is a third of the arithmetic and of the memory traffic of eight stored gradients per Gauss point.
#pragma once

#include <array>
#include <cmath>
#include <span>

#include "core/types.hpp"
#include "fem/simd_math.hpp"
#include "fem/tensor.hpp"

namespace drogue::fem {

/// Elements that are computed together, one per lane.
struct ElementBatch {
  struct Point {
    Tensor<Pack> inverse_jacobian;  ///< A [1/m]
    Pack weight;                    ///< w [m^3]
  };
  std::array<std::array<int, lanes>, 8> node;  ///< [local node][lane]
  std::array<Point, 8> point;                  ///< 2x2x2 Gauss points, xi fastest
  Point centre;
};

struct NodalForces {
  Pack component[8][3];  ///< [local node][axis] [N]
};

/// Smallest and largest volume ratio J, lane by lane.
struct VolumeRatio {
  Pack smallest, largest;
};

/// Reference geometry of a batch whose nodes are given. Of an inverted element some weight is not positive.
void prepare_geometry(ElementBatch& batch, std::span<const Vec3> reference);

/// Minus the gradient of the energy, and the range of J, at positions `x`.
template <class Law>
VolumeRatio nodal_forces(const Law& law, const ElementBatch& batch, std::span<const Vec3> x, NodalForces& forces);

/// Elastic energy [J] of each element.
template <class Law>
Pack elastic_energy(const Law& law, const ElementBatch& batch, std::span<const Vec3> x);

VolumeRatio volume_ratio(const ElementBatch& batch, std::span<const Vec3> x);

/// Largest eigenvalue of the acoustic tensor Q(N_I) [Pa/m^2] at the element's centre for each parent direction I,
/// N_I = A^T e_I, from above. Their sum bounds density times squared frequency of an element with its mass lumped
/// equally on its nodes: exact for a bar, and by the Cauchy-Schwarz inequality never too low for a parallelepiped under
/// uniform strain.
template <class Law>
std::array<Pack, 3> directional_stiffness(const Law& law, const ElementBatch& batch, std::span<const Vec3> x);

}  // namespace drogue::fem
