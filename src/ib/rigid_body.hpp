// SPDX-License-Identifier: GPL-3.0-or-later
// A rigid body that moves as prescribed: its surface as markers, forced to the body's velocity. The force and torque
// are those of the fluid outside on the body. The markers also push the fluid inside, whose momentum follows the body:
// with the marker forces F_l on the fluid,
//   F = -sum F_l + rho V dU/dt,   T = -sum r_l x F_l + rho d(I omega)/dt
// (M. Uhlmann, J. Comput. Phys. 209 (2005) 448, eq. 37 and 38), about the centre of the enclosed volume V. The first is
// exact for an incompressible fluid that does not slip, the second as long as the fluid inside turns like a solid. A
// sheet has no inside.
#pragma once

#include <string>

#include "core/archive.hpp"
#include "geometry/surface.hpp"
#include "ib/direct_forcing.hpp"
#include "ib/rigid_motion.hpp"

namespace drogue::ib {

struct RigidBodyOptions {
  Delta delta = Delta::peskin4;
  int iterations = 1;          ///< passes of forcing per step
  double spacing = 1.0;        ///< of the markers, in cells of the finest level
  double retraction = 0.0;     ///< of the markers into the body, in cells of the finest level
  double fluid_density = 1.0;  ///< [kg/m^3]
  std::string body;            ///< name for messages
};

/// By the fluid on the body.
struct Load {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< about the body's centre [N m]
};

class RigidBody : public fluid::FineStepHook {
 public:
  /// Samples the surface for the finest level of `forest`, which outlives the body. Throws InputError if the body does
  /// not lie in finest cells.
  RigidBody(const amr::Forest& forest, const geometry::Shape& shape, RigidMotion motion,
            const RigidBodyOptions& options);
  RigidBody(const RigidBody&) = delete;
  RigidBody& operator=(const RigidBody&) = delete;

  void on_fine_step(fluid::FineStep& step) override;

  const geometry::Surface& surface() const { return surface_; }  ///< at rest
  const RigidMotion& motion() const { return motion_; }
  const Load& load() const { return load_; }  ///< mean over the last step
  /// Mean over the time since the last call; resets the mean.
  Load take_mean_load();
  void transfer_state(Archive& archive);
  /// After forcing; `u` is the velocity where the last step ended.
  Slip slip(const fluid::VelocityView& u) const { return forcing_.slip(u); }

 private:
  void move(const fluid::FineStep& step, std::span<Vec3> position, std::span<Vec3> velocity) const;
  Load momentum_inside(double time, double dt) const;

  RigidBodyOptions options_;
  geometry::Surface surface_;
  RigidMotion motion_;
  std::vector<Vec3> marker_;  // at rest [m]
  DirectForcing forcing_;
  Load load_, impulse_;   // impulse_: since the mean was taken [N s], [N m s]
  double elapsed_ = 0.0;  // since then [s]
};

}  // namespace drogue::ib
