// SPDX-License-Identifier: GPL-3.0-or-later
// Elastic bodies whose surfaces may touch: each meets the fluid, then they move together, then each gives back to it.
#pragma once

#include <vector>

#include "app/elastic_body.hpp"
#include "core/stopwatch.hpp"
#include "fem/touching_structures.hpp"

namespace drogue::app {

class TouchingBodies : public Mover {
 public:
  /// The bodies outlive it. Throws InputError as fem::TouchingStructures does.
  TouchingBodies(std::vector<CoupledElasticBody*> bodies, const fem::ContactOptions& contact);

  void on_fine_step(fluid::FineStep& step) override;
  void step_alone(double time, double dt) override;
  double structure_seconds() const override { return structure_time_.seconds(); }
  void transfer_state(Archive& archive) { archive.transfer("structure_time", structure_time_); }

 private:
  std::vector<CoupledElasticBody*> bodies_;
  fem::TouchingStructures structures_;
  Stopwatch structure_time_;
};

}  // namespace drogue::app
