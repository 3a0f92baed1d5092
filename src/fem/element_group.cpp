// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/element_group.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace drogue::fem {

ElementGroup::ElementGroup(const GroupDescription& description, std::string family, int nodes_per_element,
                           std::vector<int> nodes, std::vector<int> numbers)
    : ForceGroup(nodes_per_element, std::move(nodes)),
      family_(std::move(family)),
      region_(description.region),
      bounds_(description.volume_ratio),
      number_(std::move(numbers)),
      ratios_(batches()),
      lightness_(count(), {1.0, 1.0, 1.0}),
      nodal_stiffness_(count()) {}

void ElementGroup::set_time(double time, double share) {
  fibre_ = {share * region_.active.tension(Vec3::Zero(), time), region_.active.direction};
}

std::string ElementGroup::name_of(int element) const { return fmt::format("{} {}", family_, number_[element]); }

bool ElementGroup::compute_forces(int batch, std::span<const Vec3> x) {
  const VolumeRatio j = forces_of(batch, x);
  ratios_[batch] = j;
  bool inside = true;
  for (int lane = 0; lane < lanes; ++lane) inside &= j.smallest[lane] >= bounds_[0] && j.largest[lane] <= bounds_[1];
  return inside;
}

void ElementGroup::keep_volumes() {
  for (int e = 0; e < count(); ++e) volume_.push_back(volume_of(e));
}

void ElementGroup::bound_stiffness(int batch, std::span<const Vec3> x) {
  const int first = batch * lanes, used = std::min(lanes, count() - first);
  Pack root[3]{};  // of the lightness
  for (int direction = 0; direction < 3; ++direction) {
    for (int lane = 0; lane < used; ++lane) root[direction][lane] = lightness_[first + lane][direction];
    root[direction] = square_root(root[direction]);
  }
  const Tensor<Pack> stiffness = stiffness_of(batch, x);
  const Pack bound =
      largest_eigenvalue_bound(tensor<Pack>([&](int i, int j) { return root[i] * root[j] * stiffness(i, j); }));
  for (int lane = 0; lane < used; ++lane) {
    nodal_stiffness_[first + lane] = bound[lane] * volume_[first + lane] / nodes_per_element();
  }
}

ElementGroup::Extreme ElementGroup::worst() const {
  Extreme worst{0, 1.0, 1.0};
  const auto consider = [&](int element, double j, double excess) {
    if (std::isnan(excess)) excess = INFINITY;
    if (excess > worst.excess) worst = {element, j, excess};
  };
  for (int e = 0; e < count(); ++e) {
    const double smallest = ratios_[e / lanes].smallest[e % lanes], largest = ratios_[e / lanes].largest[e % lanes];
    consider(e, smallest, smallest > 0.0 ? bounds_[0] / smallest : 1.0 / bounds_[0] - smallest);
    consider(e, largest, largest / bounds_[1]);
  }
  return worst;
}

double ElementGroup::elastic_energy(std::span<const Vec3> x) const {
  double sum = 0.0;
  for (int e = 0; e < count(); e += lanes) {
    const Pack of_batch = energy_of(e / lanes, x);
    for (int lane = 0; lane < std::min(lanes, count() - e); ++lane) sum += of_batch[lane];
  }
  return sum;
}

std::array<double, 2> ElementGroup::volume_ratio_range(std::span<const Vec3> x) const {
  std::array<double, 2> range{INFINITY, -INFINITY};
  for (int batch = 0; batch < batches(); ++batch) {
    const VolumeRatio j = volume_ratio_of(batch, x);
    for (int lane = 0; lane < lanes; ++lane) {
      range[0] = std::min(range[0], j.smallest[lane]);
      range[1] = std::max(range[1], j.largest[lane]);
    }
  }
  return range;
}

}  // namespace drogue::fem
