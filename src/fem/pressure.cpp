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
      Pack along[2][3]{};
      for (std::size_t a = 0; a < N; ++a) {
        for (int axis = 0; axis < 3; ++axis) {
          const Pack position = gather(batch_[batch][a], x, axis);
          for (int direction = 0; direction < 2; ++direction) {
            along[direction][axis] += Shape::gradient[q][a][direction] * position;
          }
        }
      }
      for (int axis = 0; axis < 3; ++axis) {
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        const Pack push = pressure_ * Shape::weight * (along[0][i] * along[1][j] - along[0][j] * along[1][i]);
        for (std::size_t a = 0; a < N; ++a) forces.component[a][axis] += Shape::value[q][a] * push;
      }
    }
    return true;
  }

  const double* force_on(int element, int local_node) const override {
    return reinterpret_cast<const double*>(forces_[element / lanes].component[local_node]) + element % lanes;
  }

 private:
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
