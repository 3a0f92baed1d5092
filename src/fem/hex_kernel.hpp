// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernels of the kinds of hexahedra share.
#pragma once

#include <algorithm>
#include <span>

#include "fem/element_batch.hpp"
#include "fem/hex_topology.hpp"
#include "fem/tensor.hpp"

namespace drogue::fem {

inline constexpr const char* hexahedron_expected =
    "the nodes of a convex hexahedron, bottom face counter-clockwise, then top face";

/// A vector field on the twelve edges or on the lines through the Gauss points, numbered like the edges.
struct LineField {
  Pack at[3][4][3];  ///< [parent direction][line][axis]
};

/// The line along `direction` through a Gauss point.
constexpr int line_through(int direction, int point) {
  const int x = point & 1, y = (point >> 1) & 1, z = point >> 2;
  if (direction == 0) return y + 2 * z;
  return direction == 1 ? x + 2 * z : x + 2 * y;
}

/// From two places at -1 and 1 to the two Gauss points, linearly, but for a factor of (1 + gauss_abscissa) / 2.
inline void interpolate(Pack& first, Pack& last) {
  constexpr double far = (1.0 - gauss_abscissa) / (1.0 + gauss_abscissa);
  const Pack at_first = first + far * last;
  last += far * first;
  first = at_first;
}

/// From differences along the edges to derivatives along the lines; a symmetric map.
inline LineField to_lines(LineField field) {
  constexpr double near = 0.5 * (1.0 + gauss_abscissa), scale = 0.5 * near * near;
  for (auto& direction : field.at) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int line = 0; line < 4; ++line) direction[line][axis] *= scale;
      interpolate(direction[0][axis], direction[1][axis]);
      interpolate(direction[2][axis], direction[3][axis]);
      interpolate(direction[0][axis], direction[2][axis]);
      interpolate(direction[1][axis], direction[3][axis]);
    }
  }
  return field;
}

/// Of the positions, last node less first.
inline LineField edge_differences(const BatchNodes<8>& node, std::span<const Vec3> x) {
  Pack position[8][3];
  for (int a = 0; a < 8; ++a) {
    for (int axis = 0; axis < 3; ++axis) {
      position[a][axis] = gather(node[a], x, axis);
    }
  }
  LineField field;
  for (int direction = 0; direction < 3; ++direction) {
    for (int line = 0; line < 4; ++line) {
      const auto [first, last] = hex_edge[direction][line];
      for (int axis = 0; axis < 3; ++axis) {
        field.at[direction][line][axis] = position[last][axis] - position[first][axis];
      }
    }
  }
  return field;
}

inline Tensor<Pack> at_gauss_point(const LineField& field, int point) {
  return tensor<Pack>(
      [&](int axis, int direction) { return field.at[direction][line_through(direction, point)][axis]; });
}

/// Derivatives at the centre.
inline Tensor<Pack> at_centre(const LineField& differences) {
  return tensor<Pack>([&](int axis, int direction) {
    const auto& lines = differences.at[direction];
    return 0.125 * (lines[0][axis] + lines[1][axis] + lines[2][axis] + lines[3][axis]);
  });
}

/// J T F f0 f0^T
inline Tensor<Pack> active_stress(const ActiveFibre& fibre, const Tensor<Pack>& f, const Pack& j) {
  const Vec3& f0 = fibre.direction;
  return tensor<Pack>(
      [&](int i, int k) { return fibre.tension * f0[k] * j * (f(i, 0) * f0[0] + f(i, 1) * f0[1] + f(i, 2) * f0[2]); });
}

/// Its derivative in the direction dF.
inline Tensor<Pack> active_tangent(const ActiveFibre& fibre, const Tensor<Pack>& f, const Tensor<Pack>& df) {
  return active_stress(fibre, f, dot(cofactor(f), df)) + active_stress(fibre, df, determinant(f));
}

/// Adds the reference volume of a lane's hexahedron to its nodes.
template <class Batch>
void lump_hexahedron(const Batch& batch, int lane, std::span<double> volume) {
  constexpr double near = 0.5 * (1.0 + gauss_abscissa), far = 1.0 - near;
  for (int a = 0; a < 8; ++a) {
    for (int q = 0; q < 8; ++q) {
      double shape = 1.0;
      for (int axis = 0; axis < 3; ++axis) shape *= ((corner_of_node[a] ^ q) >> axis) & 1 ? far : near;
      volume[batch.node[a][lane]] += shape * batch.point[q].weight[lane];
    }
  }
}

/// Between the parent directions I and J: norm of dP(F; e_k N_I^T) N_J over k, N_I = A^T e_I with `a` = A at the
/// centre. Never too low for a parallelepiped under uniform strain.
template <class Law>
Tensor<Pack> hexahedron_stiffness(const Law& law, const BatchNodes<8>& node, const Tensor<Pack>& a,
                                  std::span<const Vec3> x) {
  const auto tangent = law.tangent(at_centre(edge_differences(node, x)) * a);
  Tensor<Pack> block[3][3];  // [I][J >= I](j, k)
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const Tensor<Pack> dp = tangent(tensor<Pack>([&](int m, int n) { return m == k ? a(i, n) : Pack{}; }));
      for (int j = i; j < 3; ++j) {
        const Vector<Pack> of_k = dp * row(a, j);
        for (int m = 0; m < 3; ++m) block[i][j](m, k) = of_k(m);
      }
    }
  }
  Tensor<Pack> stiffness;
  for (int i = 0; i < 3; ++i) stiffness(i, i) = larger(largest_eigenvalue_bound(block[i][i]), Pack{});
  for (int i = 0; i < 3; ++i) {
    for (int j = i + 1; j < 3; ++j) {
      const Pack squared_norm = dot(block[i][j], block[i][j]), if_positive = stiffness(i, i) * stiffness(j, j);
      stiffness(i, j) = stiffness(j, i) = square_root(squared_norm < if_positive ? squared_norm : if_positive);
    }
  }
  return stiffness;
}

}  // namespace drogue::fem
