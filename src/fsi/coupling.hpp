// SPDX-License-Identifier: GPL-3.0-or-later
// Couples a structure with the fluid once per finest fluid step, stably for any structural density: a point carries the mass
// of fluid that its delta function drags, starts the step at the velocity common to both, and returns to the fluid the
// impulse it lost (DESIGN section 4). The two faces of a thin solid meet the fluid once, through their mean.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fem/structure.hpp"
#include "fluid/fluid_solver.hpp"
#include "ib/markers.hpp"

namespace drogue::fsi {

enum class Scheme {
  added_mass,   ///< v = (m v + M u*) / (m + M), structure with mass m + M, F = M (v_new - u*) / dt
  peskin,       ///< plain IB/FE: F = structure's force at t_n, structure moved with the interpolated velocity
};

struct CouplingOptions {
  Scheme scheme = Scheme::added_mass;
  ib::Delta delta = ib::Delta::peskin4;
  double fluid_density = 1.0;   ///< [kg/m^3]
  std::string body;             ///< name for messages and history columns
};

/// What the last fine step did.
struct CouplingRecord {
  Vec3 force = Vec3::Zero();     ///< on the body by the fluid [N]
  double slip_before = 0.0;      ///< rms of u* - v at the points, v at the start of the step [m/s]
};

class Coupling : public fluid::FineStepHook {
 public:
  /// `structure` outlives the coupling; its inertia is set here.
  Coupling(fem::Structure& structure, const amr::Forest& forest, const CouplingOptions& options);

  void on_fine_step(fluid::FineStep& step) override;

  const CouplingRecord& last() const { return record_; }
  /// Mean over the time since the last call of the force on the body [N]; resets the mean.
  Vec3 take_mean_force();
  /// Of fluid velocity minus point velocity after forcing, area-weighted over the points: mean along the reference normal,
  /// and rms of the vector [m/s].
  std::array<double, 2> slip(const fluid::VelocityView& u) const;
};

}  // namespace drogue::fsi
