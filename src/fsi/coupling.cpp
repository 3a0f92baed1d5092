// SPDX-License-Identifier: GPL-3.0-or-later
// The added-mass scheme conserves the momentum of fluid and solid to round-off whatever the masses: a point enters the
// step with m v + M u*, and what the elements and holds do to m + M is shared as m (v_new - v) for the solid and M
// (v_new - u*) for the fluid. Positions are those at the start of the step. With m = 0 the force on the fluid is the
// structure's alone, Peskin's method with the structure sub-stepped; with m -> inf it is direct forcing of the velocity
// v.
//
// Peskin's scheme (Acta Numerica 11 (2002) 479), as IB/FE codes run it: every node is a marker, for its force and its
// velocity. It is explicit, so its step is bounded by the stiffness of the solid. Nodes held rigidly have no force of
// their own; there the fluid is brought to rest by direct forcing.
#include "fsi/coupling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"

namespace drogue::fsi {

namespace {

CoupledPoints points_for(const fem::Structure& structure, const amr::Forest& forest, const CouplingOptions& options) {
  const double spacing = forest.spacing(forest.finest());
  return couple_points(structure, options.delta, spacing, options.fluid_density, options.body);
}

void expect_neutrally_buoyant(const fem::Structure& structure, const CouplingOptions& options) {
  for (std::size_t node = 0; node < structure.volume().size(); ++node) {
    if (structure.coupled_volume()[node] < structure.volume()[node]) {
      throw InputError(
          fmt::format("body '{}': the peskin scheme moves all of a body with the fluid, but node {} belongs to a "
                      "region that is not coupled; couple it, or use the added_mass scheme",
                      options.body, node));
    }
    const double displaced = options.fluid_density * structure.volume()[node];
    if (std::abs(structure.own_mass()[node] - displaced) <= 1e-9 * displaced) continue;
    throw InputError(
        fmt::format("body '{}': the peskin scheme has no inertia of the solid, so its density must be the fluid's, "
                    "{:g} kg/m^3, but is {:g}; change it, or use the added_mass scheme",
                    options.body, options.fluid_density, structure.own_mass()[node] / structure.volume()[node]));
  }
}

/// Weighted with the dragged mass, which on a sheet is proportional to the area.
double root_mean_square(std::span<const Vec3> slip, std::span<const double> weight) {
  double sum = 0.0, weights = 0.0;
  for (std::size_t p = 0; p < slip.size(); ++p) {
    sum += weight[p] * slip[p].squaredNorm();
    weights += weight[p];
  }
  return std::sqrt(sum / weights);
}

}  // namespace

Coupling::Coupling(fem::Structure& structure, const amr::Forest& forest, const CouplingOptions& options)
    : structure_(&structure),
      options_(options),
      points_(points_for(structure, forest, options)),
      markers_(forest, options.delta, options.body) {
  structure_->set_inertia(inertia_of(structure, points_, options.fluid_density));
  if (options.scheme == Scheme::peskin) {
    expect_neutrally_buoyant(structure, options);
    points_ = split_into_nodes(points_);
  }
  position_.resize(points_.size());
  fluid_velocity_.resize(points_.size());
  slip_.resize(points_.size());
  force_.resize(points_.size());
}

void Coupling::on_fine_step(fluid::FineStep& step) {
  switch (options_.scheme) {
    case Scheme::added_mass:
      step_with_added_mass(step);
      break;
    case Scheme::peskin:
      step_as_peskin(step);
      break;
  }
  impulse_ += step.dt * record_.force;
  elapsed_ += step.dt;
}

void Coupling::step_with_added_mass(fluid::FineStep& step) {
  const int points = points_.size();
#pragma omp parallel for schedule(static)
  for (int p = 0; p < points; ++p) position_[p] = structure_->mean_position(p);
  read_fluid(step);
#pragma omp parallel for schedule(static)
  for (int p = 0; p < points; ++p) {
    const double m = points_.excess_mass[p], dragged = points_.dragged_mass[p];
    slip_[p] = fluid_velocity_[p] - structure_->mean_velocity(p);
    structure_->set_mean_velocity(p, fluid_velocity_[p] - m / (m + dragged) * slip_[p]);
  }
  record_.slip_before = root_mean_square(slip_, points_.dragged_mass);
  {
    const Timed timed(structure_time_);
    structure_->advance(step.dt, step.time - step.dt);
  }
#pragma omp parallel for schedule(static)
  for (int p = 0; p < points; ++p) {
    force_[p] = points_.dragged_mass[p] / step.dt * (structure_->mean_velocity(p) - fluid_velocity_[p]);
  }
  give_to_fluid(step);
}

void Coupling::step_as_peskin(fluid::FineStep& step) {
  std::ranges::copy(structure_->position(), position_.begin());
  read_fluid(step);
  for (int p = 0; p < points_.size(); ++p) slip_[p] = fluid_velocity_[p] - structure_->velocity()[p];
  record_.slip_before = root_mean_square(slip_, points_.dragged_mass);
  const auto [smallest, largest] = structure_->volume_ratio_range();
  if (!(smallest > 0.0)) {
    throw Diverged(fmt::format("body '{}' is torn or inverted (volume ratio {:.3g} to {:.3g}) at t = {:.6g} s",
                               options_.body, smallest, largest, step.time - step.dt));
  }
  structure_->internal_force(position_, force_);
  structure_->add_hold_force(position_, structure_->velocity(), force_);
  for (int p = 0; p < points_.size(); ++p) {
    if (structure_->is_held_rigidly(p)) force_[p] = -points_.dragged_mass[p] / step.dt * fluid_velocity_[p];
  }
  give_to_fluid(step);

  markers_.interpolate(step, fluid_velocity_);
  for (int p = 0; p < points_.size(); ++p) {
    if (structure_->is_held_rigidly(p)) fluid_velocity_[p].setZero();
    position_[p] += step.dt * fluid_velocity_[p];
  }
  structure_->set_state(position_, fluid_velocity_);
}

/// Moves the markers to `position_` and interpolates the velocity there.
void Coupling::read_fluid(const fluid::FineStep& step) {
  markers_.move_to(position_);
  markers_.interpolate(step, fluid_velocity_);
}

void Coupling::give_to_fluid(fluid::FineStep& step) {
  markers_.spread(force_, step.f);
  record_.force.setZero();
  for (const Vec3& force : force_) record_.force -= force;
}

Vec3 Coupling::velocity_of(int point) const {
  return options_.scheme == Scheme::peskin ? structure_->velocity()[point] : structure_->mean_velocity(point);
}

Vec3 Coupling::take_mean_force() {
  const Vec3 impulse = std::exchange(impulse_, Vec3::Zero());
  const double elapsed = std::exchange(elapsed_, 0.0);
  return elapsed > 0.0 ? Vec3(impulse / elapsed) : Vec3::Zero();
}

void Coupling::transfer_state(Archive& archive) {
  archive.transfer("impulse", impulse_);
  archive.transfer("impulse_time", elapsed_);
  archive.transfer("structure_time", structure_time_);
}

std::array<double, 2> Coupling::slip(const fluid::VelocityView& u) const {
  if (markers_.size() == 0) return {0.0, 0.0};
  std::vector<Vec3> slip(points_.size());
  markers_.interpolate(u, slip);
  double along = 0.0, mass = 0.0;
  for (int p = 0; p < points_.size(); ++p) {
    slip[p] -= velocity_of(p);
    along += points_.dragged_mass[p] * slip[p].dot(points_.normal[p]);
    mass += points_.dragged_mass[p] * points_.normal[p].squaredNorm();
  }
  return {mass > 0.0 ? along / mass : 0.0, root_mean_square(slip, points_.dragged_mass)};
}

}  // namespace drogue::fsi
