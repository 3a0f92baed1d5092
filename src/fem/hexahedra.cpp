// SPDX-License-Identifier: GPL-3.0-or-later
// Trilinear hexahedra.
//
// In the parent cube [-1, 1]^3 a derivative along xi depends on eta and zeta alone, so each of the three columns of
// D = dx/dxi takes four values at the 2x2x2 Gauss points, interpolated from the four edges along xi. Hence
// F = D A with A = (dX/dxi)^{-1}, and the forces are the transposed interpolation of H = w P A^T, w = det dX/dxi. That
// is a third of the arithmetic and of the memory traffic of eight stored gradients per Gauss point.
//
// Of P = a F + b F F^T F + c cof F (isotropic_stress.hpp) F itself is not needed: with the stored M = A A^T
//   H = w a D M + w b D M (D^T D M) + c cof D,   F : F = D : D M,   J = det D / w,
// since cof F A^T = cof D cof A A^T = cof D det A, which saves two products of tensors.
#include "fem/batched_group.hpp"
#include "fem/hex_kernel.hpp"

namespace drogue::fem {
namespace {

struct HexBatch {
  static constexpr int nodes = 8;
  static constexpr const char* name = "hexahedron";
  static constexpr const char* expected = hexahedron_expected;

  struct Point {
    Tensor<Pack> inverse_jacobian;  ///< A [1/m]
    Pack weight, per_weight;        ///< w [m^3] and its inverse
    std::array<Pack, 6> metric;     ///< of M, xx, xy, xz, yy, yz, zz [1/m^2]
  };
  BatchNodes<8> node;
  std::array<Point, 8> point;  ///< 2x2x2 Gauss points, xi fastest
  Point centre;
};

inline HexBatch::Point geometry(const Tensor<Pack>& jacobian) {
  const Pack weight = determinant(jacobian), per_weight = 1.0 / weight;
  const Tensor<Pack> a = per_weight * transposed(cofactor(jacobian)), m = a * transposed(a);
  return {a, weight, per_weight, {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)}};
}

inline Tensor<Pack> metric_of(const HexBatch::Point& reference) {
  constexpr int place[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  return tensor<Pack>([&](int i, int j) { return reference.metric[place[i][j]]; });
}

/// Adds H of a Gauss point to the lines through it.
inline void accumulate(LineField& flux, int point, const Tensor<Pack>& h) {
  for (int direction = 0; direction < 3; ++direction) {
    for (int axis = 0; axis < 3; ++axis) flux.at[direction][line_through(direction, point)][axis] += h(axis, direction);
  }
}

/// Transpose of edge_derivatives followed by the interpolation, with the sign of a force.
inline void forces_of_flux(LineField& flux, NodalForces<8>& forces) {
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

void prepare_geometry(HexBatch& batch, const Solid&, std::span<const Vec3> reference) {
  LineField derivatives = edge_derivatives(batch.node, reference);
  batch.centre = geometry(at_centre(derivatives));
  interpolate_lines(derivatives);
  for (int point = 0; point < 8; ++point) batch.point[point] = geometry(at_gauss_point(derivatives, point));
}

void lump_volumes(const HexBatch& batch, int lane, std::span<double> volume) { lump_hexahedron(batch, lane, volume); }

template <class Law>
VolumeRatio nodal_forces(const Law& law, const ActiveFibre& fibre, const HexBatch& batch, std::span<const Vec3> x,
                         NodalForces<8>& forces) {
  LineField derivatives = edge_derivatives(batch.node, x);
  interpolate_lines(derivatives);
  LineField flux{};
  VolumeRatio range;
  for (int point = 0; point < 8; ++point) {
    const HexBatch::Point& reference = batch.point[point];
    const Tensor<Pack> d = at_gauss_point(derivatives, point), cofactor_d = cofactor(d);
    const Tensor<Pack> dm = d * metric_of(reference);
    const Pack j = dot(row(d, 0), row(cofactor_d, 0)) * reference.per_weight;
    range.extend(j);
    const IsotropicStress<Pack> p = law.response(dot(d, dm), j);
    Tensor<Pack> h = (reference.weight * p.linear) * dm + p.cofactor * cofactor_d;
    if constexpr (Law::has_cubic_stress) h += (reference.weight * p.cubic) * (dm * (transposed(d) * dm));
    if (fibre.tension != 0.0) {
      const Tensor<Pack>& a = reference.inverse_jacobian;
      h += reference.weight * (active_stress(fibre, d * a, j) * transposed(a));
    }
    accumulate(flux, point, h);
  }
  forces_of_flux(flux, forces);
  return range;
}

/// Derivatives of the shape functions at a Gauss point, [node][axis].
inline std::array<std::array<Pack, 3>, 8> shape_gradients(const HexBatch::Point& reference, int point) {
  constexpr double near = 0.5 * (1.0 + gauss_abscissa), far = 1.0 - near;
  std::array<std::array<Pack, 3>, 8> gradient{};
  for (int direction = 0; direction < 3; ++direction) {
    for (int line = 0; line < 4; ++line) {
      const int apart = line ^ line_through(direction, point);  // across, in each of two directions
      const double slope = 0.5 * (apart & 1 ? far : near) * (apart & 2 ? far : near);
      const auto [first, last] = hex_edge[direction][line];
      for (int axis = 0; axis < 3; ++axis) {
        const Pack part = slope * reference.inverse_jacobian(direction, axis);
        gradient[first][axis] -= part;
        gradient[last][axis] += part;
      }
    }
  }
  return gradient;
}

template <class Law>
void add_tangent(const Law& law, const ActiveFibre& fibre, const HexBatch& batch, std::span<const Vec3> x,
                 Stiffness<8>& stiffness) {
  LineField derivatives = edge_derivatives(batch.node, x);
  interpolate_lines(derivatives);
  for (int point = 0; point < 8; ++point) {
    const HexBatch::Point& reference = batch.point[point];
    const Tensor<Pack> f = at_gauss_point(derivatives, point) * reference.inverse_jacobian;
    const auto gradient = shape_gradients(reference, point);
    for (int k = 0; k < 3; ++k) {
      Tensor<Pack> moduli[3];  // change of the stress with F_k0, F_k1, F_k2
      for (int l = 0; l < 3; ++l) {
        const auto unit = tensor<Pack>([&](int i, int j) { return i == k && j == l ? splat<Pack>(1.0) : Pack{}; });
        moduli[l] = law.tangent(f, unit);
        if (fibre.tension != 0.0) moduli[l] = moduli[l] + active_tangent(fibre, f, unit);
        moduli[l] = reference.weight * moduli[l];
      }
      for (int b = 0; b < 8; ++b) {
        const Tensor<Pack> dp = gradient[b][0] * moduli[0] + gradient[b][1] * moduli[1] + gradient[b][2] * moduli[2];
        for (int a = 0; a < 8; ++a) {
          for (int i = 0; i < 3; ++i) {
            stiffness.component[a][i][b][k] +=
                dp(i, 0) * gradient[a][0] + dp(i, 1) * gradient[a][1] + dp(i, 2) * gradient[a][2];
          }
        }
      }
    }
  }
}

template <class Law>
Pack energy(const Law& law, const HexBatch& batch, std::span<const Vec3> x) {
  LineField derivatives = edge_derivatives(batch.node, x);
  interpolate_lines(derivatives);
  Pack sum{};
  for (int point = 0; point < 8; ++point) {
    const HexBatch::Point& reference = batch.point[point];
    sum += reference.weight * law.energy(at_gauss_point(derivatives, point) * reference.inverse_jacobian);
  }
  return sum;
}

template <class Law>
VolumeRatio volume_ratio(const Law&, const HexBatch& batch, std::span<const Vec3> x) {
  LineField derivatives = edge_derivatives(batch.node, x);
  interpolate_lines(derivatives);
  VolumeRatio range;
  for (int point = 0; point < 8; ++point) {
    range.extend(determinant(at_gauss_point(derivatives, point)) / batch.point[point].weight);
  }
  return range;
}

template <class Law>
Tensor<Pack> directional_stiffness(const Law& law, const HexBatch& batch, std::span<const Vec3> x) {
  return hexahedron_stiffness(law, batch.node, batch.centre.inverse_jacobian, x);
}

}  // namespace

std::unique_ptr<ElementGroup> make_hexahedra(const Solid& solid, const GroupDescription& group, const Mesh& mesh,
                                             const std::vector<int>& elements) {
  if (solid.element == Hexahedron::assumed_strain) return make_assumed_strain_hexahedra(solid, group, mesh, elements);
  return std::visit(
      [&](const auto& law) { return make_group<HexBatch>(law, solid, group, mesh.nodes, mesh.hexahedra, elements); },
      solid.material);
}

}  // namespace drogue::fem
