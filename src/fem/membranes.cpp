// SPDX-License-Identifier: GPL-3.0-or-later
// Membranes: bilinear quadrilaterals with 2x2 Gauss points and triangles of constant strain.
//
// In a Cartesian frame of the reference plane, its first axis along the warp, F = D A is a 3 x 2 matrix, D = dx/dxi and
// A = (dX/dxi)^{-1}; the law turns C = F^T F into the second Piola-Kirchhoff stress S of plane stress. The forces are
// those of the first one, F S, times thickness and area.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "fem/batched_group.hpp"
#include "fem/plane_tensor.hpp"
#include "fem/surface_shape.hpp"

namespace drogue::fem {
namespace {

/// A 2 x 2 or 3 x 2 matrix of packs, lane by lane.
struct PlaneMatrix {
  Pack at[2][2];
};
struct SurfaceGradient {
  Pack at[3][2];
};

template <std::size_t N>
struct MembraneBatch {
  static constexpr int nodes = N;
  static constexpr const char* name = N == 4 ? "quadrilateral" : "triangle";
  static constexpr const char* expected = "corners in order around a convex face";

  struct Point {
    PlaneMatrix inverse_jacobian;  ///< A [1/m]: [parent direction][axis of the plane]
    Pack weight;                   ///< thickness times area [m^3]
  };
  BatchNodes<N> node;
  std::array<Point, SurfaceShape<N>::points> point;
  PlaneMatrix centre;    ///< A there
  Pack direction[2][2];  ///< N_I of directional_stiffness()
};

using Matrix2 = Eigen::Matrix2d;

/// dX/dxi in the frame of the plane that the columns of `tangents` span, its first axis along `warp` as seen there.
Matrix2 in_plane(const Eigen::Matrix<double, 3, 2>& tangents, const Vec3& warp) {
  const Vec3 normal = tangents.col(0).cross(tangents.col(1)).normalized();
  Vec3 first = warp - warp.dot(normal) * normal;
  if (first.norm() < 1e-6 * warp.norm()) first = normal.unitOrthogonal();
  first.normalize();
  Eigen::Matrix<double, 3, 2> frame;
  frame << first, normal.cross(first);
  return frame.transpose() * tangents;
}

template <std::size_t N>
Eigen::Matrix<double, 3, 2> tangents_at(const double (&gradient)[N][2], const std::array<Vec3, N>& corner) {
  Eigen::Matrix<double, 3, 2> tangents = Eigen::Matrix<double, 3, 2>::Zero();
  for (std::size_t a = 0; a < N; ++a) {
    for (int direction = 0; direction < 2; ++direction) tangents.col(direction) += gradient[a][direction] * corner[a];
  }
  return tangents;
}

void put(PlaneMatrix& packs, int lane, const Matrix2& m) {
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) packs.at[i][j][lane] = m(i, j);
  }
}

/// Directions of directional_stiffness() as rows. Of a quadrilateral, in its parent square: A itself. Of a triangle the
/// gradients g_a of the shape functions have the tensor sum g_a g_a = tau_1 p_1 p_1 + tau_2 p_2 p_2; by Cauchy-Schwarz
/// the rows sqrt(3 tau_I) p_I bound its frequencies.
template <std::size_t N>
Matrix2 bounding_directions(const Matrix2& inverse_jacobian) {
  if constexpr (N == 4) return inverse_jacobian;
  Matrix2 sum = Matrix2::Zero();
  for (const auto& gradient : SurfaceShape<3>::centre_gradient) {
    const Eigen::Vector2d g = inverse_jacobian.transpose() * Eigen::Vector2d(gradient[0], gradient[1]);
    sum += g * g.transpose();
  }
  const auto eigen = Eigen::SelfAdjointEigenSolver<Matrix2>().computeDirect(sum);
  return (3.0 * eigen.eigenvalues()).cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
}

template <std::size_t N>
void prepare_geometry(MembraneBatch<N>& batch, const Membrane& membrane, std::span<const Vec3> reference) {
  using Shape = SurfaceShape<N>;
  for (int lane = 0; lane < lanes; ++lane) {
    std::array<Vec3, N> corner;
    for (std::size_t a = 0; a < N; ++a) corner[a] = reference[batch.node[a][lane]];
    const auto middle = tangents_at(Shape::centre_gradient, corner);
    const Vec3 normal = middle.col(0).cross(middle.col(1)).normalized();
    const Matrix2 centre = in_plane(middle, membrane.warp).inverse();
    put(batch.centre, lane, centre);
    const Matrix2 directions = bounding_directions<N>(centre);
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) batch.direction[i][j][lane] = directions(i, j);
    }
    for (int q = 0; q < Shape::points; ++q) {
      const auto tangents = tangents_at(Shape::gradient[q], corner);
      put(batch.point[q].inverse_jacobian, lane, in_plane(tangents, membrane.warp).inverse());
      batch.point[q].weight[lane] =
          membrane.thickness * Shape::weight * tangents.col(0).cross(tangents.col(1)).dot(normal);
    }
  }
}

template <std::size_t N>
struct Corners {
  Pack at[N][3];

  Corners(const MembraneBatch<N>& batch, std::span<const Vec3> x) {
    for (std::size_t a = 0; a < N; ++a) {
      for (int axis = 0; axis < 3; ++axis) at[a][axis] = gather(batch.node[a], x, axis);
    }
  }
};

/// F = D A with D = sum of x_a times the gradient of its shape function.
template <std::size_t N>
inline SurfaceGradient deformation(const Corners<N>& x, const double (&gradient)[N][2], const PlaneMatrix& a) {
  SurfaceGradient f;
  for (int axis = 0; axis < 3; ++axis) {
    Pack d[2]{};
    for (std::size_t n = 0; n < N; ++n) {
      for (int direction = 0; direction < 2; ++direction) d[direction] += gradient[n][direction] * x.at[n][axis];
    }
    for (int j = 0; j < 2; ++j) f.at[axis][j] = d[0] * a.at[0][j] + d[1] * a.at[1][j];
  }
  return f;
}

/// C = F^T F
inline PlaneTensor<Pack> gram(const SurfaceGradient& f) {
  const auto product = [&](int i, int j) {
    return f.at[0][i] * f.at[0][j] + f.at[1][i] * f.at[1][j] + f.at[2][i] * f.at[2][j];
  };
  return {product(0, 0), product(1, 1), product(0, 1)};
}

/// F S A^T times the weight: the flux of force along the parent directions.
inline SurfaceGradient flux(const SurfaceGradient& f, const PlaneTensor<Pack>& s, const PlaneMatrix& a,
                            const Pack& weight) {
  SurfaceGradient h;
  for (int axis = 0; axis < 3; ++axis) {
    const Pack p[2] = {weight * (f.at[axis][0] * s.xx + f.at[axis][1] * s.xy),
                       weight * (f.at[axis][0] * s.xy + f.at[axis][1] * s.yy)};
    for (int direction = 0; direction < 2; ++direction) {
      h.at[axis][direction] = p[0] * a.at[direction][0] + p[1] * a.at[direction][1];
    }
  }
  return h;
}

template <class Law, std::size_t N>
VolumeRatio nodal_forces(const Law& law, const ActiveFibre& fibre, const MembraneBatch<N>& batch,
                         std::span<const Vec3> x, NodalForces<N>& forces) {
  using Shape = SurfaceShape<N>;
  const Corners<N> corners(batch, x);
  forces = {};
  VolumeRatio range;
  for (int q = 0; q < Shape::points; ++q) {
    const auto& [a, weight] = batch.point[q];
    const SurfaceGradient f = deformation(corners, Shape::gradient[q], a);
    const PlaneTensor<Pack> c = gram(f);
    const Pack j = law.volume_ratio(c);
    range.extend(j);
    PlaneTensor<Pack> stress = law.stress(c);
    stress.xx += fibre.tension * j;  // along the warp
    const SurfaceGradient h = flux(f, stress, a, weight);
    for (std::size_t n = 0; n < N; ++n) {
      for (int axis = 0; axis < 3; ++axis) {
        forces.component[n][axis] -=
            Shape::gradient[q][n][0] * h.at[axis][0] + Shape::gradient[q][n][1] * h.at[axis][1];
      }
    }
  }
  return range;
}

/// With g_a the gradient of a shape function: w (g_a . S g_b I + F dS(F, g_b) g_a).
template <class Law, std::size_t N>
void add_tangent(const Law& law, const ActiveFibre& fibre, const MembraneBatch<N>& batch, std::span<const Vec3> x,
                 Stiffness<N>& stiffness) {
  using Shape = SurfaceShape<N>;
  const Corners<N> corners(batch, x);
  const Pack one = splat<Pack>(1.0), none{};
  const PlaneTensor<Pack> unit[3] = {{one, none, none}, {none, one, none}, {none, none, one}};
  for (int q = 0; q < Shape::points; ++q) {
    const auto& [a, weight] = batch.point[q];
    const SurfaceGradient f = deformation(corners, Shape::gradient[q], a);
    const PlaneTensor<Pack> c = gram(f);
    PlaneTensor<Pack> stress = law.stress(c), moduli[3];
    stress.xx += fibre.tension * law.volume_ratio(c);
    for (int m = 0; m < 3; ++m) {
      moduli[m] = law.tangent(c, unit[m]);
      if (fibre.tension != 0.0) moduli[m].xx += fibre.tension * law.volume_change(c, unit[m]);
    }
    Pack gradient[N][2];
    for (std::size_t n = 0; n < N; ++n) {
      for (int j = 0; j < 2; ++j) {
        gradient[n][j] = Shape::gradient[q][n][0] * a.at[0][j] + Shape::gradient[q][n][1] * a.at[1][j];
      }
    }
    for (std::size_t b = 0; b < N; ++b) {
      const Pack g0 = gradient[b][0], g1 = gradient[b][1];
      const Pack traction[2] = {weight * (stress.xx * g0 + stress.xy * g1), weight * (stress.xy * g0 + stress.yy * g1)};
      for (int k = 0; k < 3; ++k) {
        const Pack f0 = f.at[k][0], f1 = f.at[k][1];
        const PlaneTensor<Pack> ds = (2.0 * weight * f0 * g0) * moduli[0] + (2.0 * weight * f1 * g1) * moduli[1] +
                                     (weight * (f0 * g1 + f1 * g0)) * moduli[2];
        for (std::size_t n = 0; n < N; ++n) {
          const Pack along[2] = {ds.xx * gradient[n][0] + ds.xy * gradient[n][1],
                                 ds.xy * gradient[n][0] + ds.yy * gradient[n][1]};
          for (int i = 0; i < 3; ++i) {
            stiffness.component[n][i][b][k] += f.at[i][0] * along[0] + f.at[i][1] * along[1];
          }
          stiffness.component[n][k][b][k] += gradient[n][0] * traction[0] + gradient[n][1] * traction[1];
        }
      }
    }
  }
}

template <class Law, std::size_t N>
Pack energy(const Law& law, const MembraneBatch<N>& batch, std::span<const Vec3> x) {
  using Shape = SurfaceShape<N>;
  const Corners<N> corners(batch, x);
  Pack sum{};
  for (int q = 0; q < Shape::points; ++q) {
    const auto& [a, weight] = batch.point[q];
    sum += weight * law.energy(gram(deformation(corners, Shape::gradient[q], a)));
  }
  return sum;
}

template <class Law, std::size_t N>
VolumeRatio volume_ratio(const Law& law, const MembraneBatch<N>& batch, std::span<const Vec3> x) {
  using Shape = SurfaceShape<N>;
  const Corners<N> corners(batch, x);
  VolumeRatio range;
  for (int q = 0; q < Shape::points; ++q) {
    range.extend(law.volume_ratio(gram(deformation(corners, Shape::gradient[q], batch.point[q].inverse_jacobian))));
  }
  return range;
}

template <std::size_t N>
void lump_volumes(const MembraneBatch<N>& batch, int lane, std::span<double> volume) {
  for (int q = 0; q < SurfaceShape<N>::points; ++q) {
    for (std::size_t a = 0; a < N; ++a) {
      volume[batch.node[a][lane]] += SurfaceShape<N>::value[q][a] * batch.point[q].weight[lane];
    }
  }
}

/// Largest eigenvalue of a symmetric 3 x 3 matrix, from above: see hexahedra.cpp.
inline Pack largest_eigenvalue_bound(const Pack (&q)[3][3]) {
  const Pack mean = (1.0 / 3.0) * (q[0][0] + q[1][1] + q[2][2]);
  Pack square = -3.0 * mean * mean;
  for (const auto& row : q) {
    for (const Pack& entry : row) square += entry * entry;
  }
  return mean + 2.0 * square_root(larger(square, Pack{}) * (1.0 / 6.0));
}

/// Of Q(N), for which Q(N) a . a is the second derivative of the energy in the direction of a displacement gradient a
/// N.
template <class Law>
Pack largest_acoustic_eigenvalue(const Law& law, const SurfaceGradient& f, const Pack& n0, const Pack& n1) {
  const PlaneTensor<Pack> c = gram(f), s = law.stress(c);
  const Pack geometric = n0 * n0 * s.xx + 2.0 * n0 * n1 * s.xy + n1 * n1 * s.yy;
  Pack acoustic[3][3];
  for (int k = 0; k < 3; ++k) {
    const Pack f0 = f.at[k][0], f1 = f.at[k][1];
    const PlaneTensor<Pack> ds = law.tangent(c, {2.0 * f0 * n0, 2.0 * f1 * n1, f0 * n1 + f1 * n0});
    const Pack along[2] = {ds.xx * n0 + ds.xy * n1, ds.xy * n0 + ds.yy * n1};
    for (int j = 0; j < 3; ++j) acoustic[j][k] = f.at[j][0] * along[0] + f.at[j][1] * along[1];
    acoustic[k][k] += geometric;
  }
  return larger(largest_eigenvalue_bound(acoustic), Pack{});
}

/// At least that of the reference state: a fold bears nothing, but may be taut in a moment.
template <class Law, std::size_t N>
Tensor<Pack> directional_stiffness(const Law& law, const MembraneBatch<N>& batch, std::span<const Vec3> x) {
  const SurfaceGradient f = deformation(Corners<N>(batch, x), SurfaceShape<N>::centre_gradient, batch.centre);
  const Pack one = splat<Pack>(1.0 + 1e-9), none{};  // just so much that a tension field is taut
  const SurfaceGradient rest{{{one, none}, {none, one}, {none, none}}};
  std::array<Pack, 3> stiffness{};
  for (int direction = 0; direction < 2; ++direction) {
    const auto& n = batch.direction[direction];
    stiffness[direction] =
        larger(largest_acoustic_eigenvalue(law, f, n[0], n[1]), largest_acoustic_eigenvalue(law, rest, n[0], n[1]));
  }
  return directional_stiffness_of(stiffness);
}

template <std::size_t N>
std::unique_ptr<ElementGroup> make(const Membrane& membrane, const GroupDescription& group, const Mesh& mesh,
                                   const Cells<N>& cells, const std::vector<int>& elements) {
  if (!(membrane.thickness > 0.0)) {
    throw InputError(fmt::format("a membrane is {} m thick; expected a positive thickness", membrane.thickness));
  }
  return std::visit(
      [&](const auto& law) { return make_group<MembraneBatch<N>>(law, membrane, group, mesh.nodes, cells, elements); },
      membrane.material);
}

}  // namespace

std::unique_ptr<ElementGroup> make_quadrilaterals(const Membrane& membrane, const GroupDescription& group,
                                                  const Mesh& mesh, const std::vector<int>& elements) {
  return make<4>(membrane, group, mesh, mesh.quadrilaterals, elements);
}

std::unique_ptr<ElementGroup> make_triangles(const Membrane& membrane, const GroupDescription& group, const Mesh& mesh,
                                             const std::vector<int>& elements) {
  return make<3>(membrane, group, mesh, mesh.triangles, elements);
}

}  // namespace drogue::fem
