// SPDX-License-Identifier: GPL-3.0-or-later
#include "ib/direct_forcing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/error.hpp"

namespace drogue::ib {

DirectForcing::DirectForcing(const amr::Forest& forest, DirectForcingOptions options, std::vector<double> dragged_mass,
                             Motion motion)
    : options_(std::move(options)),
      dragged_mass_(std::move(dragged_mass)),
      motion_(std::move(motion)),
      markers_(forest, options_.delta, options_.body),
      position_(dragged_mass_.size(), Vec3::Zero()),
      velocity_(dragged_mass_.size(), Vec3::Zero()),
      force_(dragged_mass_.size(), Vec3::Zero()),
      marker_force_(dragged_mass_.size(), Vec3::Zero()) {
  if (options_.iterations < 1) {
    throw InputError(fmt::format("body '{}': {} iterations of direct forcing, expected at least 1", options_.body,
                                 options_.iterations));
  }
  for (std::size_t l = 0; l < dragged_mass_.size(); ++l) {
    if (dragged_mass_[l] > 0.0) continue;
    throw InputError(fmt::format("body '{}': marker {} drags a fluid mass of {:g} kg, expected a positive one",
                                 options_.body, l, dragged_mass_[l]));
  }
}

void DirectForcing::on_fine_step(fluid::FineStep& step) {
  motion_(step, position_, velocity_);
  markers_.move_to(position_);
  std::ranges::fill(marker_force_, Vec3::Zero());
  for (int pass = 0; pass < options_.iterations; ++pass) {
    markers_.interpolate(step, force_);
    for (std::size_t l = 0; l < force_.size(); ++l) {
      force_[l] = dragged_mass_[l] / step.dt * (velocity_[l] - force_[l]);
      marker_force_[l] -= force_[l];
    }
    markers_.spread(force_, step.f);
  }
}

Vec3 DirectForcing::force() const {
  return std::accumulate(marker_force_.begin(), marker_force_.end(), Vec3(Vec3::Zero()));
}

Slip DirectForcing::slip(const fluid::VelocityView& u) const {
  if (markers_.size() == 0) return {};
  std::vector<Vec3> fluid(velocity_.size());
  markers_.interpolate(u, fluid);
  double sum = 0.0, mass = 0.0, largest = 0.0;
  for (std::size_t l = 0; l < fluid.size(); ++l) {
    const double squared = (fluid[l] - velocity_[l]).squaredNorm();
    sum += dragged_mass_[l] * squared;
    mass += dragged_mass_[l];
    largest = std::max(largest, squared);
  }
  return {std::sqrt(sum / mass), std::sqrt(largest)};
}

}  // namespace drogue::ib
