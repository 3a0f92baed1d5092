// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a group of elements out of a batch type and a law (see element_batch.hpp).
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "core/error.hpp"
#include "fem/element_group.hpp"

namespace drogue::fem {

template <class Batch, class Law>
class BatchedGroup final : public ElementGroup {
 public:
  static constexpr int nodes_each = Batch::nodes;

  template <class Kind>
  BatchedGroup(const Law& law, const Kind& kind, const GroupDescription& description,
               const std::vector<Vec3>& reference, std::vector<int> nodes, std::vector<int> numbers)
      : ElementGroup(description, Batch::name, nodes_each, std::move(nodes), std::move(numbers)),
        law_(law),
        batches_(batches()),
        forces_(batches()) {
    for (int b = 0; b < batches(); ++b) {
      for (int lane = 0; lane < lanes; ++lane) {
        // Spare lanes repeat the last element; nobody reads their forces.
        const auto element = nodes_of(std::min(b * lanes + lane, count() - 1));
        for (int a = 0; a < nodes_each; ++a) batches_[b].node[a][lane] = element[a];
      }
      prepare_geometry(batches_[b], kind, reference);
    }
    expect_volume(reference);
    keep_volumes();
  }

  const double* force_on(int element, int local_node) const override {
    return reinterpret_cast<const double*>(forces_[element / lanes].component[local_node]) + element % lanes;
  }

  void compute_stiffness(int batch, std::span<const Vec3> x, Pack* matrix) const override {
    auto& stiffness = *reinterpret_cast<Stiffness<nodes_each>*>(matrix);
    stiffness = {};
    add_tangent(law_, fibre(), batches_[batch], x, stiffness);
  }

  void add_volumes(std::span<double> nodal_volume) const override {
    for (int e = 0; e < count(); ++e) lump_volumes(batches_[e / lanes], e % lanes, nodal_volume);
  }

 private:
  double volume_of(int element) const override {
    double sum = 0.0;
    for (const auto& point : batches_[element / lanes].point) sum += point.weight[element % lanes];
    return sum;
  }
  VolumeRatio forces_of(int batch, std::span<const Vec3> x) override {
    return nodal_forces(law_, fibre(), batches_[batch], x, forces_[batch]);
  }
  VolumeRatio volume_ratio_of(int batch, std::span<const Vec3> x) const override {
    return volume_ratio(law_, batches_[batch], x);
  }
  Pack energy_of(int batch, std::span<const Vec3> x) const override { return energy(law_, batches_[batch], x); }
  Tensor<Pack> stiffness_of(int batch, std::span<const Vec3> x) const override {
    return directional_stiffness(law_, batches_[batch], x);
  }

  void expect_volume(const std::vector<Vec3>& reference) const {
    for (int e = 0; e < count(); ++e) {
      for (const auto& point : batches_[e / lanes].point) {
        if (point.weight[e % lanes] > 0.0) continue;
        const Vec3& p = reference[nodes_of(e)[0]];
        throw InputError(
            fmt::format("{} near ({:g}, {:g}, {:g}) m is flat or inverted in the reference configuration "
                        "(volume {:g} m^3 at a Gauss point); expected {}",
                        name_of(e), p.x(), p.y(), p.z(), point.weight[e % lanes], Batch::expected));
      }
    }
  }

  Law law_;
  std::vector<Batch> batches_;
  std::vector<NodalForces<nodes_each>> forces_;
};

/// The `elements` of `cells`; nothing if there are none.
template <class Batch, class Law, class Kind>
std::unique_ptr<ElementGroup> make_group(const Law& law, const Kind& kind, const GroupDescription& description,
                                         const std::vector<Vec3>& reference, const Cells<Batch::nodes>& cells,
                                         const std::vector<int>& elements) {
  if (elements.empty()) return nullptr;
  std::vector<int> nodes;
  for (const int e : elements) {
    for (const int node : cells[e]) {
      if (node < 0 || node >= static_cast<int>(reference.size())) {
        throw InputError(
            fmt::format("{} {} names node {}; expected 0 to {}", Batch::name, e, node, reference.size() - 1));
      }
      nodes.push_back(node);
    }
  }
  return std::make_unique<BatchedGroup<Batch, Law>>(law, kind, description, reference, std::move(nodes), elements);
}

}  // namespace drogue::fem
