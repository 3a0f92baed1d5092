// SPDX-License-Identifier: GPL-3.0-or-later
// A rigid body in the flow, at rest or in prescribed motion.
#pragma once

#include <vector>

#include "app/coupled_body.hpp"
#include "ib/rigid_body.hpp"

namespace drogue::app {

/// Points of the surface wherever the motion takes it during the run: a few cells apart in space and along the way.
std::vector<Vec3> places_of(const Case& c, const RigidBody& body);

class CoupledRigidBody : public CoupledBody {
 public:
  /// `body` and `forest` outlive it. Throws InputError for a body that does not lie in finest cells.
  CoupledRigidBody(const Case& c, const Body& body, const amr::Forest& forest);

  void on_fine_step(fluid::FineStep& step) override { body_.on_fine_step(step); }
  BodyRow measure(const fluid::FluidSolver* fluid) override;
  void step_alone(double, double) override {}  // of no interest: the case reader wants a fluid
  void write(const std::filesystem::path& file, double time) const override;
  std::string report(const Case& c) const override;
  void transfer_state(Archive& archive) override { archive.transfer("motion", body_); }

 private:
  double wake_length(const fluid::FluidSolver& fluid) const;

  ib::RigidBody body_;
  Vec3 flow_direction_;
};

}  // namespace drogue::app
