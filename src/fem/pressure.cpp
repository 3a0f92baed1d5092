// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/pressure.hpp"

#include "fem/surface_shape.hpp"

namespace drogue::fem {
namespace {

template <std::size_t N>
class Faces final : public PressureGroup {
 public:
  explicit Faces(std::vector<int> nodes) : PressureGroup(N, std::move(nodes)), batch_(batches()), forces_(batches()) {
    for (int b = 0; b < batches(); ++b) {
      for (int lane = 0; lane < lanes; ++lane) {
        const auto face = nodes_of(std::min(b * lanes + lane, count() - 1));
        for (std::size_t a = 0; a < N; ++a) batch_[b][a][lane] = face[a];
      }
    }
  }

  bool compute_forces(int batch, std::span<const Vec3> x) override {
    using Shape = SurfaceShape<N>;
    NodalForces<N>& forces = forces_[batch];
    forces = {};
    for (int q = 0; q < Shape::points; ++q) {
      const Tangents along = tangents(batch, x, q);
      for (int axis = 0; axis < 3; ++axis) {
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        const Pack push =
            pressure_ * Shape::weight * (along.at[0][i] * along.at[1][j] - along.at[0][j] * along.at[1][i]);
        for (std::size_t a = 0; a < N; ++a) forces.component[a][axis] += Shape::value[q][a] * push;
      }
    }
    return true;
  }

  /// Unsymmetric face by face; in the sum over a surface that is closed, or whose edge is held, the difference cancels.
  void compute_stiffness(int batch, std::span<const Vec3> x, Pack* matrix) const override {
    using Shape = SurfaceShape<N>;
    auto& stiffness = *reinterpret_cast<Stiffness<N>*>(matrix);
    stiffness = {};
    for (int q = 0; q < Shape::points; ++q) {
      const Tangents along = tangents(batch, x, q);
      const double push = pressure_ * Shape::weight;
      for (std::size_t b = 0; b < N; ++b) {
        const double(&gradient)[2] = Shape::gradient[q][b];
        for (int k = 0; k < 3; ++k) {
          // e_k x (g_0 t_1 - g_1 t_0), of which only the two components across e_k are not zero
          const int i = (k + 1) % 3, j = (k + 2) % 3;
          const Pack of_i = push * (gradient[0] * along.at[1][j] - gradient[1] * along.at[0][j]);
          const Pack of_j = push * (gradient[0] * along.at[1][i] - gradient[1] * along.at[0][i]);
          for (std::size_t a = 0; a < N; ++a) {
            stiffness.component[a][i][b][k] += Shape::value[q][a] * of_i;
            stiffness.component[a][j][b][k] -= Shape::value[q][a] * of_j;
          }
        }
      }
    }
  }

  const double* force_on(int element, int local_node) const override {
    return reinterpret_cast<const double*>(forces_[element / lanes].component[local_node]) + element % lanes;
  }

 private:
  struct Tangents {
    Pack at[2][3];  ///< t_0 and t_1: derivatives of the position along the parent directions
  };
  Tangents tangents(int batch, std::span<const Vec3> x, int point) const {
    Tangents along{};
    for (std::size_t a = 0; a < N; ++a) {
      for (int axis = 0; axis < 3; ++axis) {
        const Pack position = gather(batch_[batch][a], x, axis);
        for (int direction = 0; direction < 2; ++direction) {
          along.at[direction][axis] += SurfaceShape<N>::gradient[point][a][direction] * position;
        }
      }
    }
    return along;
  }

  std::vector<BatchNodes<N>> batch_;
  std::vector<NodalForces<N>> forces_;
};

template <std::size_t N>
void add_faces(std::vector<std::unique_ptr<PressureGroup>>& groups, const Cells<N>& cells,
               const std::vector<int>& elements) {
  if (elements.empty()) return;
  std::vector<int> nodes;
  for (const int e : elements) nodes.insert(nodes.end(), cells[e].begin(), cells[e].end());
  groups.push_back(std::make_unique<Faces<N>>(std::move(nodes)));
}

}  // namespace

std::vector<std::unique_ptr<PressureGroup>> make_pressure(const Mesh& mesh, const ElementSet& elements) {
  std::vector<std::unique_ptr<PressureGroup>> groups;
  add_faces(groups, mesh.quadrilaterals, elements.quadrilaterals);
  add_faces(groups, mesh.triangles, elements.triangles);
  return groups;
}

}  // namespace drogue::fem
