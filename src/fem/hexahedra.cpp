// SPDX-License-Identifier: GPL-3.0-or-later
// Trilinear hexahedra.
//
// In the parent cube [-1, 1]^3 a derivative along xi depends on eta and zeta alone, so each of the three columns of
// D = dx/dxi takes four values at the 2x2x2 Gauss points, interpolated from the four edges along xi. Hence
// F = D A with A = (dX/dxi)^{-1}, and the forces are the transposed interpolation of H = w P A^T, w = det dX/dxi. That
// is a third of the arithmetic and of the memory traffic of eight stored gradients per Gauss point.
//
// Of P = a F + b F F^T F + c cof F (isotropic_stress.hpp) F itself is not needed: with the stored N = w A A^T
//   H = a D N + b D N (D^T D N) / w + c cof D,   F : F = D : D N / w,   J = det D / w,
// since cof F A^T = cof D cof A A^T = cof D det A, which saves two products of tensors.
//
// The forces go over the Gauss points three times, for F : F and J, for a, b and c, and for H. In between a law
// computes a logarithm and an exponential, a long chain of operations each of which waits for the one before: a
// processor has to see those of several points at a time to be busy.
#include <algorithm>

#include "fem/batched_group.hpp"
#include "fem/hex_kernel.hpp"

namespace drogue::fem {
namespace {

struct HexBatch {
  static constexpr int nodes = 8;
  static constexpr const char* name = "hexahedron";
  static constexpr const char* expected = hexahedron_expected;

  struct Point {
    Pack weight;                    ///< w [m^3]
    Tensor<Pack> inverse_jacobian;  ///< A [1/m]
  };
  /// What forces need of a point, apart from the rest so that they stream no more than that.
  struct Metric {
    Pack per_weight;                ///< 1 / w [1/m^3]
    std::array<Pack, 6> component;  ///< of N, xx, xy, xz, yy, yz, zz [m]

    Tensor<Pack> tensor() const {
      const auto& [xx, xy, xz, yy, yz, zz] = component;
      return {{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}};
    }
  };
  BatchNodes<8> node;
  bool alike = false;            ///< the metrics, as those of parallelepipeds are: the first is enough
  std::array<Metric, 8> metric;  ///< 2x2x2 Gauss points, xi fastest
  std::array<Point, 8> point;
  Tensor<Pack> inverse_jacobian;  ///< at the centre
};

inline HexBatch::Metric metric_of(const HexBatch::Point& point) {
  const auto& [w, a] = point;
  const Tensor<Pack> n = w * (a * transposed(a));
  return {1.0 / w, {n(0, 0), n(0, 1), n(0, 2), n(1, 1), n(1, 2), n(2, 2)}};
}

/// Adds H of a Gauss point to the lines through it, of which it is the first or the second.
inline void accumulate(LineField& flux, int point, const Tensor<Pack>& h) {
  for (int direction = 0; direction < 3; ++direction) {
    const bool second = point >> direction & 1;
    for (int axis = 0; axis < 3; ++axis) {
      Pack& sum = flux.at[direction][line_through(direction, point)][axis];
      sum = second ? sum + h(axis, direction) : h(axis, direction);
    }
  }
}

/// Transpose of edge_differences() followed by the interpolation, with the sign of a force.
inline void forces_of_flux(const LineField& flux, NodalForces<8>& forces) {
  const LineField edges = to_lines(flux);
  forces = {};
  for (int direction = 0; direction < 3; ++direction) {
    for (int line = 0; line < 4; ++line) {
      const auto [first, last] = hex_edge[direction][line];
      for (int axis = 0; axis < 3; ++axis) {
        const Pack f = edges.at[direction][line][axis];
        forces.component[first][axis] += f;
        forces.component[last][axis] -= f;
      }
    }
  }
}

/// Whether only rounding makes them different.
bool are_alike(const std::array<HexBatch::Metric, 8>& metrics) {
  constexpr double rounding = 1e-12;
  const HexBatch::Metric& first = metrics[0];
  const Pack largest = rounding * trace(first.tensor());
  return std::ranges::all_of(metrics, [&](const HexBatch::Metric& other) {
    const Tensor<Pack> difference = other.tensor() - first.tensor();
    const Pack of_weights = other.per_weight / first.per_weight - 1.0;
    return all(dot(difference, difference) < largest * largest) && all(of_weights * of_weights < rounding * rounding);
  });
}

void prepare_geometry(HexBatch& batch, const Solid&, std::span<const Vec3> reference) {
  const LineField edges = edge_differences(batch.node, reference), derivatives = to_lines(edges);
  batch.inverse_jacobian = inverted(at_centre(edges));
  for (int point = 0; point < 8; ++point) {
    const Tensor<Pack> jacobian = at_gauss_point(derivatives, point);
    batch.point[point] = {determinant(jacobian), inverted(jacobian)};
    batch.metric[point] = metric_of(batch.point[point]);
  }
  batch.alike = are_alike(batch.metric);
}

void lump_volumes(const HexBatch& batch, int lane, std::span<double> volume) { lump_hexahedron(batch, lane, volume); }

template <class Law>
VolumeRatio nodal_forces(const Law& law, const ActiveFibre& fibre, const HexBatch& batch, std::span<const Vec3> x,
                         NodalForces<8>& forces) {
  const LineField derivatives = to_lines(edge_differences(batch.node, x));
  const auto metric = [&](int point) -> const HexBatch::Metric& { return batch.metric[batch.alike ? 0 : point]; };
  Tensor<Pack> dn[8];
  Pack i1[8], j[8];
  VolumeRatio range;
#pragma GCC unroll 8
  for (int point = 0; point < 8; ++point) {
    const Tensor<Pack> d = at_gauss_point(derivatives, point);
    dn[point] = d * metric(point).tensor();
    i1[point] = dot(d, dn[point]) * metric(point).per_weight;
    j[point] = determinant(d) * metric(point).per_weight;
    range.extend(j[point]);
  }
  IsotropicStress<Pack> p[8];
#pragma GCC unroll 8
  for (int point = 0; point < 8; ++point) p[point] = law.response(i1[point], j[point]);
  LineField flux;
#pragma GCC unroll 8
  for (int point = 0; point < 8; ++point) {
    const Tensor<Pack> d = at_gauss_point(derivatives, point);
    Tensor<Pack> h = p[point].linear * dn[point] + p[point].cofactor * cofactor(d);
    if constexpr (Law::has_cubic_stress) {
      h += (p[point].cubic * metric(point).per_weight) * (dn[point] * (transposed(d) * dn[point]));
    }
    if (fibre.tension != 0.0) {
      const auto& [weight, a] = batch.point[point];
      h += weight * (active_stress(fibre, d * a, j[point]) * transposed(a));
    }
    accumulate(flux, point, h);
  }
  forces_of_flux(flux, forces);
  return range;
}

/// Derivatives of the shape functions at a Gauss point, [node][axis].
inline std::array<std::array<Pack, 3>, 8> shape_gradients(const Tensor<Pack>& inverse_jacobian, int point) {
  constexpr double near = 0.5 * (1.0 + gauss_abscissa), far = 1.0 - near;
  std::array<std::array<Pack, 3>, 8> gradient{};
  for (int direction = 0; direction < 3; ++direction) {
    for (int line = 0; line < 4; ++line) {
      const int apart = line ^ line_through(direction, point);  // across, in each of two directions
      const double slope = 0.5 * (apart & 1 ? far : near) * (apart & 2 ? far : near);
      const auto [first, last] = hex_edge[direction][line];
      for (int axis = 0; axis < 3; ++axis) {
        const Pack part = slope * inverse_jacobian(direction, axis);
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
  const LineField derivatives = to_lines(edge_differences(batch.node, x));
  for (int point = 0; point < 8; ++point) {
    const auto& [weight, a] = batch.point[point];
    const Tensor<Pack> f = at_gauss_point(derivatives, point) * a;
    const auto tangent = law.tangent(f);
    const auto gradient = shape_gradients(a, point);
    for (int k = 0; k < 3; ++k) {
      Tensor<Pack> moduli[3];  // change of the stress with F_k0, F_k1, F_k2
      for (int l = 0; l < 3; ++l) {
        const auto unit = tensor<Pack>([&](int i, int j) { return i == k && j == l ? splat<Pack>(1.0) : Pack{}; });
        moduli[l] = tangent(unit);
        if (fibre.tension != 0.0) moduli[l] = moduli[l] + active_tangent(fibre, f, unit);
        moduli[l] = weight * moduli[l];
      }
      for (int b = 0; b < 8; ++b) {
        const Tensor<Pack> dp = gradient[b][0] * moduli[0] + gradient[b][1] * moduli[1] + gradient[b][2] * moduli[2];
        for (int c = 0; c < 8; ++c) {
          for (int i = 0; i < 3; ++i) {
            stiffness.component[c][i][b][k] +=
                dp(i, 0) * gradient[c][0] + dp(i, 1) * gradient[c][1] + dp(i, 2) * gradient[c][2];
          }
        }
      }
    }
  }
}

template <class Law>
Pack energy(const Law& law, const HexBatch& batch, std::span<const Vec3> x) {
  const LineField derivatives = to_lines(edge_differences(batch.node, x));
  Pack sum{};
  for (int point = 0; point < 8; ++point) {
    const auto& [weight, a] = batch.point[point];
    sum += weight * law.energy(at_gauss_point(derivatives, point) * a);
  }
  return sum;
}

template <class Law>
VolumeRatio volume_ratio(const Law&, const HexBatch& batch, std::span<const Vec3> x) {
  const LineField derivatives = to_lines(edge_differences(batch.node, x));
  VolumeRatio range;
  for (int point = 0; point < 8; ++point) {
    range.extend(determinant(at_gauss_point(derivatives, point)) * batch.metric[point].per_weight);
  }
  return range;
}

template <class Law>
Tensor<Pack> directional_stiffness(const Law& law, const HexBatch& batch, std::span<const Vec3> x) {
  return hexahedron_stiffness(law, batch.node, batch.inverse_jacobian, x);
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
