// SPDX-License-Identifier: GPL-3.0-or-later
// Direct forcing of bodies that move as prescribed: each marker gives the fluid the impulse that brings it to the
// marker's velocity,
//   F_l = M_l (v_l - u_l) / dt,   u = u* + kappa f interpolated to the marker,
// with the fluid mass M_l that it drags (M. Uhlmann, J. Comput. Phys. 209 (2005) 448, for the idea). One pass leaves
// the slip that varies over a few cells; further passes reduce it (multi-direct forcing; Luo et al., Phys. Rev. E 76
// (2007) 066709).
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fluid/fluid_solver.hpp"
#include "ib/markers.hpp"

namespace drogue::ib {

/// Fills the markers' positions [m] and velocities [m/s] at the end of a step.
using Motion = std::function<void(const fluid::FineStep& step, std::span<Vec3> position, std::span<Vec3> velocity)>;

struct DirectForcingOptions {
  Delta delta = Delta::peskin4;
  int iterations = 1;  ///< passes of forcing per step
  std::string body;    ///< name for messages
};

/// Fluid minus marker velocity [m/s].
struct Slip {
  double rms = 0.0;  ///< weighted with the dragged mass
  double max = 0.0;
};

class DirectForcing : public fluid::FineStepHook {
 public:
  /// `dragged_mass` [kg] per marker (ib/dragged_mass.hpp). Throws InputError if it is not positive, or without a pass.
  DirectForcing(const amr::Forest& forest, DirectForcingOptions options, std::vector<double> dragged_mass,
                Motion motion);

  void on_fine_step(fluid::FineStep& step) override;

  int size() const { return markers_.size(); }
  std::span<const Vec3> position() const { return position_; }          ///< [m] at the last step
  std::span<const Vec3> velocity() const { return velocity_; }          ///< [m/s] at the last step
  std::span<const Vec3> marker_force() const { return marker_force_; }  ///< by the fluid, over the last step [N]
  Vec3 force() const;                                                   ///< their sum [N]
  /// `u` is the velocity after forcing. Nothing before the first step.
  Slip slip(const fluid::VelocityView& u) const;

 private:
  DirectForcingOptions options_;
  std::vector<double> dragged_mass_;
  Motion motion_;
  Markers markers_;
  std::vector<Vec3> position_, velocity_, force_, marker_force_;
};

}  // namespace drogue::ib
