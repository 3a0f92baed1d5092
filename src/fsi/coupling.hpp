// SPDX-License-Identifier: GPL-3.0-or-later
// Couples a structure with the fluid once per finest fluid step, stably for any structural density: a point carries the
// mass of fluid that its delta function drags, starts the step at the velocity common to both, and returns to the fluid
// the impulse it lost (DESIGN section 4). The two faces of a thin solid meet the fluid once, through their mean.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/stopwatch.hpp"
#include "fem/structure.hpp"
#include "fluid/fluid_solver.hpp"
#include "fsi/coupled_points.hpp"
#include "ib/markers.hpp"

namespace drogue::fsi {

enum class Scheme {
  added_mass,  ///< v = (m v + M u*) / (m + M), structure with mass m + M, F = M (v_new - u*) / dt
  peskin,      ///< plain IB/FE: F = structure's force at t_n, structure moved with the interpolated velocity
};

struct CouplingOptions {
  Scheme scheme = Scheme::added_mass;
  ib::Delta delta = ib::Delta::peskin4;
  double fluid_density = 1.0;  ///< [kg/m^3]
  std::string body;            ///< name for messages and history columns
};

/// What the last fine step did.
struct CouplingRecord {
  Vec3 force = Vec3::Zero();  ///< on the body by the fluid [N]
  double slip_before = 0.0;   ///< rms of u* - v at the points, v at the start of the step [m/s]
};

class Coupling : public fluid::FineStepHook {
 public:
  /// `structure` outlives the coupling; its inertia is set here. Throws InputError if the solid is too light (see
  /// couple_points), or, for `peskin`, not of the fluid's density or not coupled as a whole.
  Coupling(fem::Structure& structure, const amr::Forest& forest, const CouplingOptions& options);

  /// Points through which the body meets the fluid.
  int points() const { return points_.size(); }

  /// Throws InputError if the body leaves the finest blocks, Diverged if an element is torn.
  void on_fine_step(fluid::FineStep& step) override;
  /// What the added-mass scheme does in it before and after the structure advances, for structures that advance
  /// together.
  void meet_fluid(const fluid::FineStep& step);
  void part_from_fluid(fluid::FineStep& step);

  const CouplingRecord& last() const { return record_; }
  /// Mean over the time since the last call of the force on the body [N]; resets the mean.
  Vec3 take_mean_force();
  /// Wall time spent in the structure so far [s].
  double structure_seconds() const { return structure_time_.seconds(); }
  /// Of fluid velocity minus point velocity after forcing, area-weighted over the points: mean along the reference
  /// normal (of a thin solid), and rms of the vector [m/s]. Taken where the last force was spread.
  std::array<double, 2> slip(const fluid::VelocityView& u) const;

  /// Saves or restores what the next mean force has summed so far; the structure's state is its own.
  void transfer_state(Archive& archive);

 private:
  void step_as_peskin(fluid::FineStep& step);
  void read_fluid(const fluid::FineStep& step);
  void give_to_fluid(fluid::FineStep& step);
  Vec3 velocity_of(int point) const;

  fem::Structure* structure_;
  CouplingOptions options_;
  CoupledPoints points_;
  ib::Markers markers_;  // one per point
  std::vector<Vec3> position_, fluid_velocity_, slip_, force_;
  CouplingRecord record_;
  Stopwatch structure_time_;
  Vec3 impulse_ = Vec3::Zero();  // on the body since the mean was taken [N s]
  double elapsed_ = 0.0;         // since then [s]
};

}  // namespace drogue::fsi
