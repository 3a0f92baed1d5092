// SPDX-License-Identifier: GPL-3.0-or-later
// Fields on a hexahedron as sums over the eight products of parent coordinates, sum_m c_m phi_m: bit d of m says
// whether phi_m contains xi_d. Corners and Gauss points are numbered alike, bit d for the side of xi_d > 0, so that
// sums over them are fast Walsh transforms.
#pragma once

#include <span>

#include "fem/element_batch.hpp"
#include "fem/hex_topology.hpp"
#include "fem/tensor.hpp"

namespace drogue::fem {

constexpr int bit(int direction) { return 1 << direction; }

/// Coefficients of a vector field.
struct VectorModes {
  Vector<Pack> at[8];
};

/// Of a tensor field without xi eta zeta.
struct TensorModes {
  Tensor<Pack> at[7];
};

/// Sums over the corners, each value times phi_m there.
inline void sum_corners(Pack (&value)[8]) {
  for (int d = 0; d < 3; ++d) {
    for (int m = 0; m < 8; ++m) {
      if (m & bit(d)) continue;
      const Pack difference = value[m | bit(d)] - value[m];
      value[m] += value[m | bit(d)];
      value[m | bit(d)] = difference;
    }
  }
}

/// Values at the corners from coefficients: the transpose.
inline void to_corners(Pack (&value)[8]) {
  for (int d = 0; d < 3; ++d) {
    for (int m = 0; m < 8; ++m) {
      if (m & bit(d)) continue;
      const Pack sum = value[m] + value[m | bit(d)];
      value[m] -= value[m | bit(d)];
      value[m | bit(d)] = sum;
    }
  }
}

/// phi_m at a node.
constexpr double mode_at_node(int m, int node) {
  double product = 1.0;
  for (int d = 0; d < 3; ++d) {
    if ((m & bit(d)) && !(corner_of_node[node] & bit(d))) product = -product;
  }
  return product;
}

inline VectorModes modes_of_nodes(const BatchNodes<8>& node, std::span<const Vec3> x) {
  VectorModes modes;
  for (int axis = 0; axis < 3; ++axis) {
    Pack value[8];
    for (int a = 0; a < 8; ++a) value[corner_of_node[a]] = 0.125 * gather(node[a], x, axis);
    sum_corners(value);
    for (int m = 0; m < 8; ++m) modes.at[m](axis) = value[m];
  }
  return modes;
}

/// The transpose, from what works on coefficients to what works on nodes: component[node][axis].
inline void add_to_nodes(const VectorModes& modes, double factor, Pack (&component)[8][3]) {
  for (int axis = 0; axis < 3; ++axis) {
    Pack value[8];
    for (int m = 0; m < 8; ++m) value[m] = (0.125 * factor) * modes.at[m](axis);
    to_corners(value);
    for (int a = 0; a < 8; ++a) component[a][axis] += value[corner_of_node[a]];
  }
}

/// phi_m at the Gauss points over that at the corners.
constexpr double gauss_scale(int m) {
  double product = 1.0;
  for (int d = 0; d < 3; ++d) product *= m & bit(d) ? gauss_abscissa : 1.0;
  return product;
}

inline void to_gauss_points(const TensorModes& modes, Tensor<Pack> (&at_point)[8]) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      Pack value[8]{};
      for (int m = 0; m < 7; ++m) value[m] = gauss_scale(m) * modes.at[m](i, j);
      to_corners(value);
      for (int q = 0; q < 8; ++q) at_point[q](i, j) = value[q];
    }
  }
}

/// The transpose, times a weight that all points share.
inline TensorModes sum_gauss_points(const Tensor<Pack> (&at_point)[8], const Pack& weight) {
  TensorModes modes;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      Pack value[8];
      for (int q = 0; q < 8; ++q) value[q] = at_point[q](i, j);
      sum_corners(value);
      for (int m = 0; m < 7; ++m) modes.at[m](i, j) = (gauss_scale(m) * weight) * value[m];
    }
  }
  return modes;
}

/// Derivative of phi_m along xi_d at a Gauss point.
constexpr double mode_slope(int m, int d, int point) {
  if (!(m & bit(d))) return 0.0;
  double product = 1.0;
  for (int e = 0; e < 3; ++e) {
    if (e != d && (m & bit(e))) product *= point & bit(e) ? gauss_abscissa : -gauss_abscissa;
  }
  return product;
}

}  // namespace drogue::fem
