// SPDX-License-Identifier: GPL-3.0-or-later
#include "ib/direct_forcing.hpp"

#include <fmt/format.h>

#include <cmath>
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
      force_(dragged_mass_.size(), Vec3::Zero()) {
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
  motion_(step.time, position_, velocity_);
  markers_.move_to(position_);
  force_on_body_.setZero();
  for (int pass = 0; pass < options_.iterations; ++pass) {
    markers_.interpolate(step, force_);
    for (std::size_t l = 0; l < force_.size(); ++l) {
      force_[l] = dragged_mass_[l] / step.dt * (velocity_[l] - force_[l]);
      force_on_body_ -= force_[l];
    }
    markers_.spread(force_, step.f);
  }
}

double DirectForcing::slip(const fluid::VelocityView& u) const {
  std::vector<Vec3> fluid(velocity_.size());
  markers_.interpolate(u, fluid);
  double sum = 0.0, mass = 0.0;
  for (std::size_t l = 0; l < fluid.size(); ++l) {
    sum += dragged_mass_[l] * (fluid[l] - velocity_[l]).squaredNorm();
    mass += dragged_mass_[l];
  }
  return mass > 0.0 ? std::sqrt(sum / mass) : 0.0;
}

}  // namespace drogue::ib
