// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/touching_bodies.hpp"

#include <utility>

namespace drogue::app {

namespace {

std::vector<fem::Structure*> structures_of(const std::vector<CoupledElasticBody*>& bodies) {
  std::vector<fem::Structure*> structures;
  for (CoupledElasticBody* body : bodies) structures.push_back(&body->structure());
  return structures;
}

}  // namespace

TouchingBodies::TouchingBodies(std::vector<CoupledElasticBody*> bodies, const fem::ContactOptions& contact)
    : bodies_(std::move(bodies)), structures_(structures_of(bodies_), contact) {}

void TouchingBodies::on_fine_step(fluid::FineStep& step) {
  for (CoupledElasticBody* body : bodies_) body->coupling().meet_fluid(step);
  step_alone(step.time - step.dt, step.dt);
  for (CoupledElasticBody* body : bodies_) body->coupling().part_from_fluid(step);
}

void TouchingBodies::step_alone(double time, double dt) {
  const Timed timed(structure_time_);
  structures_.advance(dt, time);
}

}  // namespace drogue::app
