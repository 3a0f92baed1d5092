// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/stiffness.hpp"

namespace drogue::fem {

TangentStiffness::TangentStiffness(const Elements& elements) : elements_(elements) {
  for (const ForceGroup* group : elements.force_groups()) {
    Group& added = groups_.emplace_back(Group{group, {}});
    added.matrices.resize(static_cast<std::size_t>(group->batches()) * added.rows() * added.rows());
  }
}

void TangentStiffness::update(std::span<const Vec3> x) {
#pragma omp parallel num_threads(elements_.threads())
  for (Group& group : groups_) {
    const int batches = group.elements->batches(), size = group.rows() * group.rows();
#pragma omp for schedule(static) nowait
    for (int batch = 0; batch < batches; ++batch) {
      group.elements->compute_stiffness(batch, x, group.matrices.data() + static_cast<std::size_t>(batch) * size);
    }
  }
}

std::vector<TangentStiffness::Coupling> TangentStiffness::couplings() const {
  std::vector<Coupling> all;
  for (const Group& group : groups_) {
    const int rows = group.rows();
    const auto* values = reinterpret_cast<const double*>(group.matrices.data());
    for (int e = 0; e < group.elements->count(); ++e) {
      const auto nodes = group.elements->nodes_of(e);
      const double* matrix = values + static_cast<std::size_t>(e / lanes) * rows * rows * lanes + e % lanes;
      for (int a = 0; a < std::ssize(nodes); ++a) {
        for (int b = 0; b < std::ssize(nodes); ++b) {
          const double* block = matrix + 3 * (a * rows + b) * lanes;
          all.push_back({nodes[a], nodes[b], {block, rows * lanes, lanes}});
        }
      }
    }
  }
  return all;
}

std::vector<Vec3> TangentStiffness::times(std::span<const Vec3> u) const {
  std::vector<Vec3> product(u.size(), Vec3::Zero());
  for (const auto& [node, other, block] : couplings()) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) product[node][i] += block(i, j) * u[other][j];
    }
  }
  return product;
}

}  // namespace drogue::fem
