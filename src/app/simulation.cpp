// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/simulation.hpp"

#include "app/scene.hpp"
#include "lbm/solver.hpp"

namespace drogue::app {

/// All that moves, one after the other, and how long it takes.
class Simulation::TimedHook : public fluid::FineStepHook {
 public:
  explicit TimedHook(const std::vector<Mover*>& movers) : movers_(movers) {}

  void on_fine_step(fluid::FineStep& step) override {
    const Timed timed(watch_);
    for (Mover* mover : movers_) mover->on_fine_step(step);
  }
  double seconds() const { return watch_.seconds(); }
  void transfer_state(Archive& archive) { archive.transfer("time_spent", watch_); }

 private:
  const std::vector<Mover*>& movers_;
  Stopwatch watch_;
};

Simulation::Simulation(const Case& c, const std::filesystem::path& folder) : case_(c) {
  const Meshes meshes = load_meshes(c, folder);
  if (c.has_fluid()) fluid_ = lbm::make_solver(make_forest(c, meshes), c.fluid);
  bodies_ = make_bodies(c, meshes, fluid_ ? &fluid_->forest() : nullptr);
  touching_ = make_touching(c, bodies_);
  for (const auto& body : bodies_) {
    if (!touching_ || is_rigid(body->description)) movers_.push_back(body.get());
  }
  if (touching_) movers_.push_back(touching_.get());
  hook_ = std::make_unique<TimedHook>(movers_);
}

Simulation::~Simulation() = default;

void Simulation::step() {
  const Timed timed(stepping_);
  if (fluid_) {
    fluid_->step(movers_.empty() ? nullptr : hook_.get());
    return;
  }
  for (Mover* mover : movers_) mover->step_alone(time(), time_step());
  ++steps_;
}

double Simulation::time() const { return fluid_ ? fluid_->time() : steps_ * case_.structure.step; }
double Simulation::time_step() const { return fluid_ ? fluid_->coarse_dt() : case_.structure.step; }

void Simulation::transfer_state(Archive& archive) {
  if (fluid_) archive.transfer("fluid", *fluid_);
  archive.transfer("steps", steps_);
  for (auto& body : bodies_) archive.transfer("body_" + body->description.name, *body);
  if (touching_) archive.transfer("touching", *touching_);
  archive.transfer("hook", *hook_);
  archive.transfer("time_spent", stepping_);
}

double Simulation::structure_seconds() const {
  double seconds = 0.0;
  for (const Mover* mover : movers_) seconds += mover->structure_seconds();
  return seconds;
}

double Simulation::coupling_seconds() const { return fluid_ ? hook_->seconds() : structure_seconds(); }

}  // namespace drogue::app
