// SPDX-License-Identifier: GPL-3.0-or-later
#include "ib/rigid_body.hpp"

#include <utility>

#include "ib/dragged_mass.hpp"

namespace drogue::ib {

namespace {

constexpr double twist_step = 1.0 / 16.0;  // of the time step, over which the motion is differentiated

std::vector<Vec3> retracted(const geometry::Surface& surface, double distance) {
  std::vector<Vec3> marker(surface.point.size());
  for (std::size_t l = 0; l < marker.size(); ++l) marker[l] = surface.point[l] - distance * surface.normal[l];
  return marker;
}

void place(const Pose& pose, std::span<const Vec3> at_rest, std::span<Vec3> position) {
  for (std::size_t l = 0; l < at_rest.size(); ++l) position[l] = pose(at_rest[l]);
}

/// The mass hangs on the distances between the markers alone, which do not change.
std::vector<double> dragged_mass(const amr::Forest& forest, const geometry::Surface& surface,
                                 std::span<const Vec3> marker, const RigidMotion& motion,
                                 const RigidBodyOptions& options) {
  std::vector<Vec3> position(marker.size());
  place(motion.pose(0.0), marker, position);
  Markers markers(forest, options.delta, options.body);
  markers.move_to(position);
  return mass_dragged(markers, forest, surface.area, options.fluid_density);
}

}  // namespace

RigidBody::RigidBody(const amr::Forest& forest, const geometry::Shape& shape, RigidMotion motion,
                     const RigidBodyOptions& options)
    : options_(options),
      surface_(shape.sample(options.spacing * forest.spacing(forest.finest()))),
      motion_(std::move(motion)),
      marker_(retracted(surface_, options.retraction * forest.spacing(forest.finest()))),
      forcing_(forest, {options.delta, options.iterations, options.body},
               dragged_mass(forest, surface_, marker_, motion_, options),
               [this](const fluid::FineStep& step, std::span<Vec3> position, std::span<Vec3> velocity) {
                 move(step, position, velocity);
               }) {}

void RigidBody::move(const fluid::FineStep& step, std::span<Vec3> position, std::span<Vec3> velocity) const {
  place(motion_.pose(step.time), marker_, position);
  const Twist twist = motion_.twist(step.time, twist_step * step.dt);
  for (std::size_t l = 0; l < position.size(); ++l) velocity[l] = twist(position[l]);
}

void RigidBody::on_fine_step(fluid::FineStep& step) {
  forcing_.on_fine_step(step);
  const Vec3 centre = motion_.pose(step.time)(surface_.enclosed.centre);
  const Load before = momentum_inside(step.time - step.dt, step.dt), after = momentum_inside(step.time, step.dt);
  load_ = {(after.force - before.force) / step.dt, (after.torque - before.torque) / step.dt};
  for (int l = 0; l < forcing_.size(); ++l) {
    const Vec3& force = forcing_.marker_force()[l];
    load_.force += force;
    load_.torque += (forcing_.position()[l] - centre).cross(force);
  }
  impulse_.force += step.dt * load_.force;
  impulse_.torque += step.dt * load_.torque;
  elapsed_ += step.dt;
}

/// Momentum [N s] and angular momentum about the centre [N m s] of the fluid inside.
Load RigidBody::momentum_inside(double time, double dt) const {
  const Pose pose = motion_.pose(time);
  const Twist twist = motion_.twist(time, twist_step * dt);
  const geometry::Solid& solid = surface_.enclosed;
  const Mat3 inertia = pose.rotation * solid.inertia * pose.rotation.transpose();
  return {options_.fluid_density * solid.volume * twist(pose(solid.centre)),
          options_.fluid_density * inertia * twist.spin};
}

Load RigidBody::take_mean_load() {
  const Load impulse = std::exchange(impulse_, Load{});
  const double elapsed = std::exchange(elapsed_, 0.0);
  if (elapsed == 0.0) return {};
  return {impulse.force / elapsed, impulse.torque / elapsed};
}

void RigidBody::transfer_state(Archive& archive) {
  archive.transfer("impulse", impulse_.force);
  archive.transfer("angular_impulse", impulse_.torque);
  archive.transfer("elapsed", elapsed_);
}

}  // namespace drogue::ib
