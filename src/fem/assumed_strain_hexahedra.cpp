// SPDX-License-Identifier: GPL-3.0-or-later
// Hexahedra with an assumed gradient, which bend without locking.
//
// In the parent cube x = sum_m x_m phi_m, where phi_m is the product of the parent coordinates in the set m. With the
// mean gradient F_0, exact for linear fields in an element of any shape, and the hourglass vectors h_m = x_m - F_0 X_m,
// which vanish for them, the gradient at the 2x2x2 Gauss points is
//   F = F_0 + sum_d xi_d M_d + sum_d xi_e xi_f L_d,   {d, e, f} = {1, 2, 3}.
// M_d is that of a plate that is bent about its plane xi_d = 0: the part of the hourglass vectors in that plane, and
// across it the stretch that plane stress asks for, -nu/(1 - nu) times their trace; no shear across. L_d is that of a
// bar along xi_d, which contracts by nu on both sides. A trilinear field has parasitic shear instead, and no
// contraction.
//
// Exact for bending of parallelepipeds, where it is what the enhanced strains of Simo, Armero & Taylor (CMAME 110
// (1993) 359) condense to for small strains, and the stabilisation of Belytschko & Bindeman (CMAME 105 (1993) 225) with
// the law at all Gauss points. No internal unknowns, no inner iteration; F follows the nodes, so forces have an energy.
// Only the ratio nu is that of small strains; an error of it changes the energy of bending in second order.
#include "fem/batched_group.hpp"
#include "fem/hex_kernel.hpp"

namespace drogue::fem {
namespace {

/// The coefficients x_m of a nodal field; m has bit d for the parent coordinate d.
struct Modes {
  Vector<Pack> at[8];
};

constexpr int bit(int direction) { return 1 << direction; }
constexpr int hourglass[4] = {3, 5, 6, 7};
/// Corners of the parent cube in the order of an element's nodes, as bits of (xi, eta, zeta).
constexpr int corner[8] = {0, 1, 3, 2, 4, 5, 7, 6};

struct AssumedStrainBatch {
  static constexpr int nodes = 8;
  static constexpr const char* name = "hexahedron";
  static constexpr const char* expected =
      "the nodes of a convex hexahedron, bottom face counter-clockwise, then top face";

  struct Point {
    Pack weight;  ///< of a volume integral [m^3]
  };
  /// Of the plane xi_d = 0 of the parallelepiped that the edges through the centre span.
  struct Plane {
    Vector<Pack> normal;   ///< unit
    Vector<Pack> dual[3];  ///< reciprocal to the two edges in the plane, by direction [1/m]
  };
  struct Edge {
    Vector<Pack> direction;  ///< unit
    Vector<Pack> slope;      ///< direction over half the length [1/m]
  };
  BatchNodes<8> node;
  std::array<Point, 8> point;
  Pack weight;                    ///< of a Gauss point in the energy [m^3]: an eighth of the volume
  Modes mean_gradient;            ///< beta_m: F_0 = sum x_m beta_m^T [1/m]
  Modes reference;                ///< X_m [m]
  Tensor<Pack> inverse_jacobian;  ///< [1/m]
  Plane plane[3];
  Edge edge[3];
};

/// From corner values to coefficients (`share` 1/2), or transposed from forces on coefficients to those on corners.
inline void butterfly(Pack& first, Pack& last) {
  const Pack difference = last - first;
  first += last;
  last = difference;
}

inline Modes modes_of(const BatchNodes<8>& node, std::span<const Vec3> x) {
  Modes modes;
  for (int axis = 0; axis < 3; ++axis) {
    Pack value[8];
    for (int a = 0; a < 8; ++a) value[corner[a]] = 0.125 * gather(node[a], x, axis);
    for (int d = 0; d < 3; ++d) {
      for (int m = 0; m < 8; ++m) {
        if ((m & bit(d)) == 0) butterfly(value[m], value[m | bit(d)]);
      }
    }
    for (int m = 0; m < 8; ++m) modes.at[m](axis) = value[m];
  }
  return modes;
}

/// The transpose, with the sign of a force.
inline void forces_of(const Modes& flux, NodalForces<8>& forces) {
  for (int axis = 0; axis < 3; ++axis) {
    Pack value[8];
    for (int m = 0; m < 8; ++m) value[m] = -0.125 * flux.at[m](axis);
    for (int d = 0; d < 3; ++d) {
      for (int m = 0; m < 8; ++m) {
        if (m & bit(d)) continue;
        const Pack sum = value[m] + value[m | bit(d)];
        value[m] = value[m] - value[m | bit(d)];
        value[m | bit(d)] = sum;
      }
    }
    for (int a = 0; a < 8; ++a) forces.component[a][axis] = value[corner[a]];
  }
}

/// Tensors by the set of the parent coordinates that multiply them.
using TensorModes = std::array<Tensor<Pack>, 7>;

/// Values at the Gauss points from coefficients of 1, xi, eta, xi eta, ...
inline void to_gauss_points(const TensorModes& modes, Tensor<Pack> (&value)[8]) {
  constexpr double s = gauss_abscissa;
  constexpr double scale[7] = {1.0, s, s, s * s, s, s * s, s * s};
  for (int k = 0; k < 9; ++k) {
    Pack v[8];
    for (int m = 0; m < 7; ++m) v[m] = scale[m] * modes[m](k / 3, k % 3);
    v[7] = Pack{};
    for (int d = 0; d < 3; ++d) {
      for (int m = 0; m < 8; ++m) {
        if (m & bit(d)) continue;
        const Pack sum = v[m] + v[m | bit(d)];
        v[m] = v[m] - v[m | bit(d)];
        v[m | bit(d)] = sum;
      }
    }
    for (int q = 0; q < 8; ++q) value[q](k / 3, k % 3) = v[q];
  }
}

/// The transpose.
inline TensorModes from_gauss_points(const Tensor<Pack> (&value)[8], const Pack& weight) {
  constexpr double s = gauss_abscissa;
  constexpr double scale[7] = {1.0, s, s, s * s, s, s * s, s * s};
  TensorModes modes;
  for (int k = 0; k < 9; ++k) {
    Pack v[8];
    for (int q = 0; q < 8; ++q) v[q] = value[q](k / 3, k % 3);
    for (int d = 0; d < 3; ++d) {
      for (int m = 0; m < 8; ++m) {
        if ((m & bit(d)) == 0) butterfly(v[m], v[m | bit(d)]);
      }
    }
    for (int m = 0; m < 7; ++m) modes[m](k / 3, k % 3) = scale[m] * weight * v[m];
  }
  return modes;
}

constexpr int plate(int d) { return bit(d); }    ///< the mode of M_d
constexpr int bar(int d) { return 7 ^ bit(d); }  ///< the mode of L_d

/// M_d and L_d from the hourglass vectors c; `nu` is Poisson's ratio.
inline TensorModes hourglass_gradient(const AssumedStrainBatch& batch, double nu, const Modes& c) {
  TensorModes k;
  for (int d = 0; d < 3; ++d) {
    const auto& [normal, dual] = batch.plane[d];
    Tensor<Pack> in_plane{};
    for (int b = 0; b < 3; ++b) {
      if (b == d) continue;
      const Vector<Pack>& v = c.at[bit(d) | bit(b)];
      in_plane = in_plane + outer(v - dot(normal, v) * normal, dual[b]);
    }
    k[plate(d)] = in_plane - outer(nu / (1.0 - nu) * trace(in_plane) * normal, normal);

    const auto& [direction, slope] = batch.edge[d];
    const Pack stretch = dot(slope, c.at[7]);
    k[bar(d)] = outer((1.0 + nu) * stretch * direction, direction);
    for (int i = 0; i < 3; ++i) k[bar(d)](i, i) -= nu * stretch;
  }
  return k;
}

/// The transpose.
inline Modes hourglass_flux(const AssumedStrainBatch& batch, double nu, const TensorModes& s) {
  Modes c{};
  for (int d = 0; d < 3; ++d) {
    const auto& [normal, dual] = batch.plane[d];
    const Tensor<Pack>& on_plate = s[plate(d)];
    const Pack across = nu / (1.0 - nu) * dot(normal, on_plate * normal);
    for (int b = 0; b < 3; ++b) {
      if (b == d) continue;
      const Vector<Pack> v = on_plate * dual[b];
      c.at[bit(d) | bit(b)] = c.at[bit(d) | bit(b)] + v - dot(normal, v) * normal - across * dual[b];
    }
    const auto& [direction, slope] = batch.edge[d];
    const Tensor<Pack>& on_bar = s[bar(d)];
    c.at[7] = c.at[7] + ((1.0 + nu) * dot(direction, on_bar * direction) - nu * trace(on_bar)) * slope;
  }
  return c;
}

struct Kinematics {
  const AssumedStrainBatch& batch;
  double nu;
  Tensor<Pack> f0, inverse;
  Modes pulled_back;  ///< F_0^-1 x_m of the hourglass modes
  TensorModes k;

  Kinematics(const AssumedStrainBatch& b, double poisson, std::span<const Vec3> positions) : batch(b), nu(poisson) {
    const Modes x = modes_of(batch.node, positions);
    f0 = outer(x.at[1], batch.mean_gradient.at[1]);
    for (int m = 2; m < 8; ++m) f0 = f0 + outer(x.at[m], batch.mean_gradient.at[m]);
    inverse = inverted(f0);
    Modes c;
    for (const int m : hourglass) {
      pulled_back.at[m] = inverse * x.at[m];
      c.at[m] = pulled_back.at[m] - batch.reference.at[m];
    }
    k = hourglass_gradient(batch, nu, c);
  }

  TensorModes gradient() const {
    TensorModes f;
    f[0] = f0;
    for (int m = 1; m < 7; ++m) f[m] = f0 * k[m];
    return f;
  }

  /// What works on the coefficients of the positions, from what works on those of the gradient.
  Modes flux(const TensorModes& stress) const {
    Tensor<Pack> on_f0 = stress[0];
    TensorModes on_k;
    for (int m = 1; m < 7; ++m) {
      on_f0 = on_f0 + stress[m] * transposed(k[m]);
      on_k[m] = transposed(f0) * stress[m];
    }
    Modes flux = hourglass_flux(batch, nu, on_k);
    for (const int m : hourglass) {
      flux.at[m] = transposed(inverse) * flux.at[m];
      on_f0 = on_f0 - outer(flux.at[m], pulled_back.at[m]);
    }
    for (int m = 1; m < 8; ++m) flux.at[m] = flux.at[m] + on_f0 * batch.mean_gradient.at[m];
    return flux;
  }
};

inline Vector<Pack> normalized(const Vector<Pack>& a) { return (1.0 / square_root(dot(a, a))) * a; }

void prepare_geometry(AssumedStrainBatch& batch, const Solid&, std::span<const Vec3> reference) {
  batch.reference = modes_of(batch.node, reference);
  LineField derivatives = edge_derivatives(batch.node, reference);
  interpolate_lines(derivatives);
  batch.mean_gradient = {};
  Pack volume{};
  for (int q = 0; q < 8; ++q) {
    const Tensor<Pack> jacobian = at_gauss_point(derivatives, q);
    batch.point[q].weight = determinant(jacobian);
    volume += batch.point[q].weight;
    const Tensor<Pack> cof = cofactor(jacobian);
    for (int m = 1; m < 8; ++m) {
      // the derivative of phi_m along xi_d
      Vector<Pack> slope{};
      for (int d = 0; d < 3; ++d) {
        if (!(m & bit(d))) continue;
        double product = 1.0;
        for (int e = 0; e < 3; ++e) {
          if (e != d && (m & bit(e))) product *= (q & bit(e)) ? gauss_abscissa : -gauss_abscissa;
        }
        slope(d) = splat<Pack>(product);
      }
      batch.mean_gradient.at[m] = batch.mean_gradient.at[m] + cof * slope;
    }
  }
  for (int m = 1; m < 8; ++m) batch.mean_gradient.at[m] = (1.0 / volume) * batch.mean_gradient.at[m];
  batch.weight = 0.125 * volume;
  Tensor<Pack> jacobian = tensor<Pack>([&](int i, int d) { return batch.reference.at[bit(d)](i); });
  batch.inverse_jacobian = inverted(jacobian);
  for (int d = 0; d < 3; ++d) {
    auto& [normal, dual] = batch.plane[d];
    normal = normalized(row(batch.inverse_jacobian, d));
    for (int b = 0; b < 3; ++b) {
      const Vector<Pack> other = row(batch.inverse_jacobian, b);
      dual[b] = other - dot(other, normal) * normal;
    }
    const Vector<Pack> half_edge = column(jacobian, d);
    const Vector<Pack> direction = normalized(half_edge);
    batch.edge[d] = {direction, (1.0 / square_root(dot(half_edge, half_edge))) * direction};
  }
}

void lump_volumes(const AssumedStrainBatch& batch, int lane, std::span<double> volume) {
  lump_hexahedron(batch, lane, volume);
}

template <class Law>
VolumeRatio nodal_forces(const Law& law, const ActiveFibre& fibre, const AssumedStrainBatch& batch,
                         std::span<const Vec3> x, NodalForces<8>& forces) {
  const Kinematics kinematics(batch, law.poisson(), x);
  Tensor<Pack> at_point[8];
  to_gauss_points(kinematics.gradient(), at_point);
  VolumeRatio range;
  for (Tensor<Pack>& value : at_point) {
    const Tensor<Pack> f = value;
    const Pack j = determinant(f);
    range.extend(j);
    value = law.stress(f);
    if (fibre.tension != 0.0) value = value + active_stress(fibre, f, j);
  }
  forces_of(kinematics.flux(from_gauss_points(at_point, batch.weight)), forces);
  return range;
}

template <class Law>
Pack energy(const Law& law, const AssumedStrainBatch& batch, std::span<const Vec3> x) {
  Tensor<Pack> f[8];
  to_gauss_points(Kinematics(batch, law.poisson(), x).gradient(), f);
  Pack sum{};
  for (const Tensor<Pack>& of_point : f) sum += law.energy(of_point);
  return batch.weight * sum;
}

template <class Law>
VolumeRatio volume_ratio(const Law& law, const AssumedStrainBatch& batch, std::span<const Vec3> x) {
  Tensor<Pack> f[8];
  to_gauss_points(Kinematics(batch, law.poisson(), x).gradient(), f);
  VolumeRatio range;
  for (const Tensor<Pack>& of_point : f) range.extend(determinant(of_point));
  return range;
}

template <class Law>
std::array<Pack, 3> directional_stiffness(const Law& law, const AssumedStrainBatch& batch, std::span<const Vec3> x) {
  return hexahedron_stiffness(law, batch.node, batch.inverse_jacobian, x);
}

}  // namespace

std::unique_ptr<ElementGroup> make_assumed_strain_hexahedra(const Solid& solid, const GroupDescription& group,
                                                            const Mesh& mesh, const std::vector<int>& elements) {
  return std::visit(
      [&](const auto& law) {
        return make_group<AssumedStrainBatch>(law, solid, group, mesh.nodes, mesh.hexahedra, elements);
      },
      solid.material);
}

}  // namespace drogue::fem
