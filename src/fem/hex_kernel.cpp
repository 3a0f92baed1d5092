// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/hex_kernel.hpp"

#include <utility>

#include "fem/hex_topology.hpp"
#include "fem/neo_hookean.hpp"
#include "fem/saint_venant_kirchhoff.hpp"

namespace drogue::fem {
namespace {

/// A vector field on the twelve edges or, interpolated, on the lines through the Gauss points, numbered like the edges.
struct LineField {
  Pack at[3][4][3];  ///< [parent direction][line][axis]
};

/// The line along `direction` through a Gauss point.
constexpr int line_through(int direction, int point) {
  const int x = point & 1, y = (point >> 1) & 1, z = point >> 2;
  if (direction == 0) return y + 2 * z;
  return direction == 1 ? x + 2 * z : x + 2 * y;
}

/// Linear interpolation between two places at -1 and 1 to the two Gauss points; it is its own transpose.
inline void interpolate(Pack& first, Pack& last) {
  const Pack mean = 0.5 * (first + last);
  const Pack slope = (0.5 * gauss_abscissa) * (last - first);
  first = mean - slope;
  last = mean + slope;
}

inline void interpolate_lines(LineField& field) {
  for (auto& direction : field.at) {
    for (int axis = 0; axis < 3; ++axis) {
      interpolate(direction[0][axis], direction[1][axis]);
      interpolate(direction[2][axis], direction[3][axis]);
      interpolate(direction[0][axis], direction[2][axis]);
      interpolate(direction[1][axis], direction[3][axis]);
    }
  }
}

template <std::size_t... lane>
inline Pack gather(const std::array<int, lanes>& node, const Vec3* x, int axis, std::index_sequence<lane...>) {
  return Pack{x[node[lane]][axis]...};
}

/// Derivatives of the positions along the edges.
inline LineField edge_derivatives(const ElementBatch& batch, std::span<const Vec3> x) {
  Pack position[8][3];
  for (int a = 0; a < 8; ++a) {
    for (int axis = 0; axis < 3; ++axis) {
      position[a][axis] = gather(batch.node[a], x.data(), axis, std::make_index_sequence<lanes>{});
    }
  }
  LineField field;
  for (int direction = 0; direction < 3; ++direction) {
    for (int line = 0; line < 4; ++line) {
      const auto [first, last] = hex_edge[direction][line];
      for (int axis = 0; axis < 3; ++axis) {
        field.at[direction][line][axis] = 0.5 * (position[last][axis] - position[first][axis]);
      }
    }
  }
  return field;
}

inline Tensor<Pack> at_gauss_point(const LineField& field, int point) {
  return tensor<Pack>(
      [&](int axis, int direction) { return field.at[direction][line_through(direction, point)][axis]; });
}

inline Tensor<Pack> at_centre(const LineField& edges) {
  return tensor<Pack>([&](int axis, int direction) {
    const auto& lines = edges.at[direction];
    return 0.25 * (lines[0][axis] + lines[1][axis] + lines[2][axis] + lines[3][axis]);
  });
}

inline ElementBatch::Point geometry(const Tensor<Pack>& jacobian) {
  const Pack weight = determinant(jacobian);
  return {(1.0 / weight) * transposed(cofactor(jacobian)), weight};
}

/// Adds w P A^T of a Gauss point to the lines through it.
inline void accumulate(LineField& flux, int point, const Tensor<Pack>& stress, const ElementBatch::Point& reference) {
  const Tensor<Pack> h = reference.weight * (stress * transposed(reference.inverse_jacobian));
  for (int direction = 0; direction < 3; ++direction) {
    for (int axis = 0; axis < 3; ++axis) flux.at[direction][line_through(direction, point)][axis] += h(axis, direction);
  }
}

/// Transpose of edge_derivatives followed by the interpolation, with the sign of a force.
inline void forces_of_flux(LineField& flux, NodalForces& forces) {
  interpolate_lines(flux);
  forces = {};
  for (int direction = 0; direction < 3; ++direction) {
    for (int line = 0; line < 4; ++line) {
      const auto [first, last] = hex_edge[direction][line];
      for (int axis = 0; axis < 3; ++axis) {
        const Pack half = 0.5 * flux.at[direction][line][axis];
        forces.component[first][axis] += half;
        forces.component[last][axis] -= half;
      }
    }
  }
}

inline void extend(VolumeRatio& range, const Pack& j) {
  // Ordered so that a NaN replaces the range: a position that is none makes J NaN at every point.
  range.smallest = range.smallest < j ? range.smallest : j;
  range.largest = range.largest > j ? range.largest : j;
}

inline VolumeRatio empty_range() { return {splat<Pack>(INFINITY), splat<Pack>(-INFINITY)}; }

inline Pack square_root(const Pack& x) {
  Pack root;
  for (int lane = 0; lane < lanes; ++lane) root[lane] = std::sqrt(x[lane]);
  return root;
}

/// Upper bound of the largest eigenvalue of a symmetric tensor: mean + 2 sqrt(p), p = |q - mean|^2 / 6. Exact if the
/// two others are equal, as those of the acoustic tensor of an isotropic solid are; at most 4/3 of it for a positive
/// one.
inline Pack largest_eigenvalue_bound(const Tensor<Pack>& q) {
  const Pack mean = (1.0 / 3.0) * trace(q);
  const Pack deviation = larger(dot(q, q) - 3.0 * mean * mean, Pack{});
  return mean + 2.0 * square_root(deviation * (1.0 / 6.0));
}

}  // namespace

void prepare_geometry(ElementBatch& batch, std::span<const Vec3> reference) {
  LineField derivatives = edge_derivatives(batch, reference);
  batch.centre = geometry(at_centre(derivatives));
  interpolate_lines(derivatives);
  for (int point = 0; point < 8; ++point) batch.point[point] = geometry(at_gauss_point(derivatives, point));
}

template <class Law>
VolumeRatio nodal_forces(const Law& law, const ElementBatch& batch, std::span<const Vec3> x, NodalForces& forces) {
  LineField derivatives = edge_derivatives(batch, x);
  interpolate_lines(derivatives);
  LineField flux{};
  VolumeRatio range = empty_range();
  for (int point = 0; point < 8; ++point) {
    const Tensor<Pack> f = at_gauss_point(derivatives, point) * batch.point[point].inverse_jacobian;
    extend(range, determinant(f));
    accumulate(flux, point, law.stress(f), batch.point[point]);
  }
  forces_of_flux(flux, forces);
  return range;
}

template <class Law>
Pack elastic_energy(const Law& law, const ElementBatch& batch, std::span<const Vec3> x) {
  LineField derivatives = edge_derivatives(batch, x);
  interpolate_lines(derivatives);
  Pack energy{};
  for (int point = 0; point < 8; ++point) {
    const ElementBatch::Point& reference = batch.point[point];
    energy += reference.weight * law.energy(at_gauss_point(derivatives, point) * reference.inverse_jacobian);
  }
  return energy;
}

VolumeRatio volume_ratio(const ElementBatch& batch, std::span<const Vec3> x) {
  LineField derivatives = edge_derivatives(batch, x);
  interpolate_lines(derivatives);
  VolumeRatio range = empty_range();
  for (int point = 0; point < 8; ++point) {
    extend(range, determinant(at_gauss_point(derivatives, point)) / batch.point[point].weight);
  }
  return range;
}

template <class Law>
std::array<Pack, 3> directional_stiffness(const Law& law, const ElementBatch& batch, std::span<const Vec3> x) {
  const Tensor<Pack>& a = batch.centre.inverse_jacobian;
  const Tensor<Pack> f = at_centre(edge_derivatives(batch, x)) * a;
  std::array<Pack, 3> stiffness;
  for (int direction = 0; direction < 3; ++direction) {
    Tensor<Pack> acoustic;
    for (int k = 0; k < 3; ++k) {
      const Tensor<Pack> df = tensor<Pack>([&](int i, int j) { return i == k ? a(direction, j) : Pack{}; });
      const Tensor<Pack> dp = law.tangent(f, df);
      for (int j = 0; j < 3; ++j) {
        acoustic(j, k) = dp(j, 0) * a(direction, 0) + dp(j, 1) * a(direction, 1) + dp(j, 2) * a(direction, 2);
      }
    }
    stiffness[direction] = larger(largest_eigenvalue_bound(acoustic), Pack{});
  }
  return stiffness;
}

template VolumeRatio nodal_forces(const NeoHookean&, const ElementBatch&, std::span<const Vec3>, NodalForces&);
template VolumeRatio nodal_forces(const SaintVenantKirchhoff&, const ElementBatch&, std::span<const Vec3>,
                                  NodalForces&);
template Pack elastic_energy(const NeoHookean&, const ElementBatch&, std::span<const Vec3>);
template Pack elastic_energy(const SaintVenantKirchhoff&, const ElementBatch&, std::span<const Vec3>);
template std::array<Pack, 3> directional_stiffness(const NeoHookean&, const ElementBatch&, std::span<const Vec3>);
template std::array<Pack, 3> directional_stiffness(const SaintVenantKirchhoff&, const ElementBatch&,
                                                   std::span<const Vec3>);

}  // namespace drogue::fem
