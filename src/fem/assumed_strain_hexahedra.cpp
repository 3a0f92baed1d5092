// SPDX-License-Identifier: GPL-3.0-or-later
// Hexahedra with an assumed gradient, which bend without locking and bear incompressibility.
//
// With x = sum_m x_m phi_m (hex_modes.hpp) and the mean gradient F_0 over the element, which is exact for linear fields
// whatever its shape, the hourglass vectors c_m = F_0^{-1} x_m - X_m of the four modes of higher order vanish for them.
// The gradient at the 2x2x2 Gauss points is
//   F = F_0 (I + sum_d xi_d K_d + sum_d xi_e xi_f L_d),   {d, e, f} = {1, 2, 3},
// with K_d that of a plate bent about its plane xi_d = 0: in the plane what the hourglass vectors make there, across it
// the stretch of plane stress, -nu / (1 - nu) times their trace, and no shear; and L_d that of a bar along xi_d, which
// contracts by nu on both sides. The trilinear field has parasitic shear in their place, and no contraction.
//
// For small strains of parallelepipeds this is what the enhanced strains of Simo, Armero & Taylor (Comput. Methods
// Appl. Mech. Eng. 110 (1993) 359) condense to, and the stabilisation of Belytschko & Bindeman (ibid. 105 (1993) 225),
// here with the law at all Gauss points. F follows the nodes alone: no internal unknowns, and forces that have an
// energy. Rotations of the element leave K_d and L_d as they are. nu is that of small strains; being wrong about it
// costs energy of bending in second order only. All points weigh the same, an eighth of the volume, so that the mean of
// F is F_0.
#include "fem/batched_group.hpp"
#include "fem/hex_kernel.hpp"
#include "fem/hex_modes.hpp"

namespace drogue::fem {
namespace {

struct AssumedStrainBatch {
  static constexpr int nodes = 8;
  static constexpr const char* name = "hexahedron";
  static constexpr const char* expected = hexahedron_expected;

  struct Point {
    Pack weight;  ///< its share of the volume, to be lumped on the nodes [m^3]
  };
  /// The plane xi_d = 0 of the parallelepiped that the edges through the centre span.
  struct Plane {
    Vector<Pack> normal;   ///< unit
    Vector<Pack> dual[3];  ///< by direction, reciprocal to the two edges in the plane [1/m]
  };
  /// Through the centre.
  struct Edge {
    Vector<Pack> direction;  ///< unit
    Vector<Pack> slope;      ///< the same over half the edge's length [1/m]
  };
  BatchNodes<8> node;
  std::array<Point, 8> point;
  Pack weight;                ///< of each Gauss point in the energy [m^3]
  VectorModes reference;      ///< X_m [m]
  VectorModes mean_gradient;  ///< of phi_m over the element, beta_m: F_0 = sum_m x_m beta_m^T [1/m]
  Plane plane[3];
  Edge edge[3];
  Tensor<Pack> inverse_jacobian;  ///< at the centre [1/m]
};

constexpr int hourglass_modes[4] = {3, 5, 6, 7};
constexpr int plate(int d) { return bit(d); }    ///< the mode of K_d
constexpr int bar(int d) { return 7 ^ bit(d); }  ///< the mode of L_d

inline Vector<Pack> normalized(const Vector<Pack>& a) { return (1.0 / square_root(dot(a, a))) * a; }

void prepare_geometry(AssumedStrainBatch& batch, const Solid&, std::span<const Vec3> reference) {
  const LineField derivatives = to_lines(edge_differences(batch.node, reference));
  batch.mean_gradient = {};
  Pack volume{};
  for (int q = 0; q < 8; ++q) {
    const Tensor<Pack> jacobian = at_gauss_point(derivatives, q), adjugate = cofactor(jacobian);
    batch.point[q].weight = determinant(jacobian);
    volume += batch.point[q].weight;
    for (int m = 1; m < 8; ++m) {
      for (int d = 0; d < 3; ++d) {
        batch.mean_gradient.at[m] += splat<Pack>(mode_slope(m, d, q)) * column(adjugate, d);
      }
    }
  }
  for (Vector<Pack>& gradient : batch.mean_gradient.at) gradient = (1.0 / volume) * gradient;
  batch.weight = 0.125 * volume;

  batch.reference = modes_of_nodes(batch.node, reference);
  const auto jacobian = tensor<Pack>([&](int i, int d) { return batch.reference.at[bit(d)](i); });
  batch.inverse_jacobian = inverted(jacobian);
  for (int d = 0; d < 3; ++d) {
    auto& [normal, dual] = batch.plane[d];
    normal = normalized(row(batch.inverse_jacobian, d));
    for (int b = 0; b < 3; ++b) {
      const Vector<Pack> reciprocal = row(batch.inverse_jacobian, b);
      dual[b] = reciprocal - dot(reciprocal, normal) * normal;
    }
    const Vector<Pack> half_edge = column(jacobian, d);
    batch.edge[d] = {normalized(half_edge), (1.0 / dot(half_edge, half_edge)) * half_edge};
  }
}

void lump_volumes(const AssumedStrainBatch& batch, int lane, std::span<double> volume) {
  lump_hexahedron(batch, lane, volume);
}

/// K_d and L_d of the hourglass vectors `c`.
inline TensorModes hourglass_gradient(const AssumedStrainBatch& batch, double nu, const VectorModes& c) {
  TensorModes k;
  for (int d = 0; d < 3; ++d) {
    const auto& [normal, dual] = batch.plane[d];
    Tensor<Pack> in_plane{};
    for (int b = 0; b < 3; ++b) {
      if (b == d) continue;
      const Vector<Pack>& v = c.at[bit(d) | bit(b)];
      in_plane += outer(v - dot(normal, v) * normal, dual[b]);
    }
    k.at[plate(d)] = in_plane - outer(nu / (1.0 - nu) * trace(in_plane) * normal, normal);

    const auto& [direction, slope] = batch.edge[d];
    const Pack stretch = dot(slope, c.at[7]);
    k.at[bar(d)] = outer((1.0 + nu) * stretch * direction, direction);
    for (int i = 0; i < 3; ++i) k.at[bar(d)](i, i) -= nu * stretch;
  }
  return k;
}

/// The transpose: what works on `c`.
inline VectorModes hourglass_flux(const AssumedStrainBatch& batch, double nu, const TensorModes& on_k) {
  VectorModes on_c{};
  for (int d = 0; d < 3; ++d) {
    const auto& [normal, dual] = batch.plane[d];
    const Pack across = nu / (1.0 - nu) * dot(normal, on_k.at[plate(d)] * normal);
    for (int b = 0; b < 3; ++b) {
      if (b == d) continue;
      const Vector<Pack> v = on_k.at[plate(d)] * dual[b];
      on_c.at[bit(d) | bit(b)] += v - dot(normal, v) * normal - across * dual[b];
    }
    const auto& [direction, slope] = batch.edge[d];
    const Tensor<Pack>& on_bar = on_k.at[bar(d)];
    on_c.at[7] += ((1.0 + nu) * dot(direction, on_bar * direction) - nu * trace(on_bar)) * slope;
  }
  return on_c;
}

inline Tensor<Pack> mean_gradient(const AssumedStrainBatch& batch, const VectorModes& x) {
  Tensor<Pack> f = outer(x.at[1], batch.mean_gradient.at[1]);
  for (int m = 2; m < 8; ++m) f += outer(x.at[m], batch.mean_gradient.at[m]);
  return f;
}

/// F = F_0 (I + K) of a batch, K = sum xi_d K_d + ..., and the transpose of its derivative.
struct AssumedGradient {
  const AssumedStrainBatch& batch;
  double nu;
  Tensor<Pack> f0, inverse;
  VectorModes pulled_back;  ///< F_0^{-1} x_m of the hourglass modes
  TensorModes k;            ///< K, without the mean

  AssumedGradient(const AssumedStrainBatch& of, double poisson, std::span<const Vec3> positions)
      : batch(of), nu(poisson) {
    const VectorModes x = modes_of_nodes(batch.node, positions);
    f0 = mean_gradient(batch, x);
    inverse = inverted(f0);
    VectorModes c;
    for (const int m : hourglass_modes) {
      pulled_back.at[m] = inverse * x.at[m];
      c.at[m] = pulled_back.at[m] - batch.reference.at[m];
    }
    k = hourglass_gradient(batch, nu, c);
  }

  TensorModes modes() const {
    TensorModes f;
    f.at[0] = f0;
    for (int m = 1; m < 7; ++m) f.at[m] = f0 * k.at[m];
    return f;
  }

  /// What works on the positions from what works on the gradient, the stress.
  VectorModes flux(const TensorModes& stress) const {
    Tensor<Pack> on_f0 = stress.at[0];
    TensorModes on_k;
    for (int m = 1; m < 7; ++m) {
      on_f0 += stress.at[m] * transposed(k.at[m]);
      on_k.at[m] = transposed(f0) * stress.at[m];
    }
    VectorModes flux = hourglass_flux(batch, nu, on_k);
    for (const int m : hourglass_modes) {
      flux.at[m] = transposed(inverse) * flux.at[m];
      on_f0 = on_f0 - outer(flux.at[m], pulled_back.at[m]);
    }
    for (int m = 1; m < 8; ++m) flux.at[m] += on_f0 * batch.mean_gradient.at[m];
    return flux;
  }
};

template <class Law>
VolumeRatio nodal_forces(const Law& law, const ActiveFibre& fibre, const AssumedStrainBatch& batch,
                         std::span<const Vec3> x, NodalForces<8>& forces) {
  const AssumedGradient gradient(batch, law.poisson(), x);
  Tensor<Pack> at_point[8];
  to_gauss_points(gradient.modes(), at_point);
  VolumeRatio range;
  for (Tensor<Pack>& value : at_point) {
    const Tensor<Pack> f = value;
    const Pack j = determinant(f);
    range.extend(j);
    value = law.stress(f);
    if (fibre.tension != 0.0) value = value + active_stress(fibre, f, j);
  }
  forces = {};
  add_to_nodes(gradient.flux(sum_gauss_points(at_point, batch.weight)), -1.0, forces.component);
  return range;
}

template <class Law>
Pack energy(const Law& law, const AssumedStrainBatch& batch, std::span<const Vec3> x) {
  Tensor<Pack> f[8];
  to_gauss_points(AssumedGradient(batch, law.poisson(), x).modes(), f);
  Pack sum{};
  for (const Tensor<Pack>& at_point : f) sum += law.energy(at_point);
  return batch.weight * sum;
}

template <class Law>
VolumeRatio volume_ratio(const Law& law, const AssumedStrainBatch& batch, std::span<const Vec3> x) {
  Tensor<Pack> f[8];
  to_gauss_points(AssumedGradient(batch, law.poisson(), x).modes(), f);
  VolumeRatio range;
  for (const Tensor<Pack>& at_point : f) range.extend(determinant(at_point));
  return range;
}

/// That of the trilinear hexahedron: of the modes that a plate or a bar shares with it the energy is not higher, and
/// linear fields, which have the highest frequencies, are the same.
template <class Law>
Tensor<Pack> directional_stiffness(const Law& law, const AssumedStrainBatch& batch, std::span<const Vec3> x) {
  return hexahedron_stiffness(law, batch.node, batch.inverse_jacobian, x);
}

/// Change of an AssumedGradient with a nodal field dx.
struct GradientChange {
  const AssumedGradient& at;
  Tensor<Pack> f0;
  VectorModes c;  ///< of pulled_back as well
  TensorModes k;

  GradientChange(const AssumedGradient& gradient, const VectorModes& dx) : at(gradient) {
    f0 = mean_gradient(at.batch, dx);
    for (const int m : hourglass_modes) c.at[m] = at.inverse * (dx.at[m] - f0 * at.pulled_back.at[m]);
    k = hourglass_gradient(at.batch, at.nu, c);
  }

  TensorModes modes() const {
    TensorModes df;
    df.at[0] = f0;
    for (int m = 1; m < 7; ++m) df.at[m] = f0 * at.k.at[m] + at.f0 * k.at[m];
    return df;
  }

  /// Of AssumedGradient::flux().
  VectorModes flux(const TensorModes& stress, const TensorModes& dstress) const {
    Tensor<Pack> on_f0 = dstress.at[0];
    TensorModes on_k, don_k;
    for (int m = 1; m < 7; ++m) {
      on_f0 += dstress.at[m] * transposed(at.k.at[m]) + stress.at[m] * transposed(k.at[m]);
      on_k.at[m] = transposed(at.f0) * stress.at[m];
      don_k.at[m] = transposed(f0) * stress.at[m] + transposed(at.f0) * dstress.at[m];
    }
    const VectorModes on_c = hourglass_flux(at.batch, at.nu, on_k);
    VectorModes flux = hourglass_flux(at.batch, at.nu, don_k);
    const Tensor<Pack> pull = transposed(at.inverse);
    for (const int m : hourglass_modes) {
      const Vector<Pack> on_x = pull * on_c.at[m];
      flux.at[m] = pull * (flux.at[m] - transposed(f0) * on_x);
      on_f0 = on_f0 - outer(flux.at[m], at.pulled_back.at[m]) - outer(on_x, c.at[m]);
    }
    for (int m = 1; m < 8; ++m) flux.at[m] += on_f0 * at.batch.mean_gradient.at[m];
    return flux;
  }
};

template <class Law>
void add_tangent(const Law& law, const ActiveFibre& fibre, const AssumedStrainBatch& batch, std::span<const Vec3> x,
                 Stiffness<8>& stiffness) {
  const AssumedGradient gradient(batch, law.poisson(), x);
  Tensor<Pack> f[8], value[8];
  to_gauss_points(gradient.modes(), f);
  for (int q = 0; q < 8; ++q) {
    value[q] = law.stress(f[q]);
    if (fibre.tension != 0.0) value[q] += active_stress(fibre, f[q], determinant(f[q]));
  }
  const TensorModes stress = sum_gauss_points(value, batch.weight);
  for (int b = 0; b < 8; ++b) {
    for (int k = 0; k < 3; ++k) {
      VectorModes dx{};
      for (int m = 0; m < 8; ++m) dx.at[m](k) = splat<Pack>(0.125 * mode_at_node(m, b));
      const GradientChange change(gradient, dx);
      Tensor<Pack> df[8];
      to_gauss_points(change.modes(), df);
      for (int q = 0; q < 8; ++q) {
        value[q] = law.tangent(f[q])(df[q]);
        if (fibre.tension != 0.0) value[q] += active_tangent(fibre, f[q], df[q]);
      }
      Pack column[8][3]{};
      add_to_nodes(change.flux(stress, sum_gauss_points(value, batch.weight)), 1.0, column);
      for (int a = 0; a < 8; ++a) {
        for (int i = 0; i < 3; ++i) stiffness.component[a][i][b][k] += column[a][i];
      }
    }
  }
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
