// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/recorder.hpp"

namespace drogue::app {

Recorder::Recorder(const Case& c, const Simulation& simulation, const std::filesystem::path& folder)
    : case_(c),
      folder_(folder),
      flow_direction_(flow_direction(c)),
      history_(folder / "history.csv", c),
      row_due_(c.output.history, Schedule::Zero::always),
      snapshots_(c.output, folder) {
  if (const auto* fluid = simulation.fluid()) flow_.emplace(c, *fluid);
}

void Recorder::start(const Simulation& simulation) {
  const Timed timed(watch_);
  history_.start();
  snapshots_.start();
  row_due_.skip(simulation.time(), simulation.time_step());
  snapshots_.write_due(simulation);
}

void Recorder::resume(const Simulation& simulation) {
  const Timed timed(watch_);
  history_.resume();
  snapshots_.resume(simulation);
  row_due_.skip(simulation.time(), simulation.time_step());
}

void Recorder::transfer_state(Archive& archive) {
  archive.transfer("history", history_);
  archive.transfer("snapshots", snapshots_);
  if (flow_) archive.transfer("flow", *flow_);
  archive.transfer("cell_updates_at_row", updates_at_row_);
  archive.transfer("seconds_at_row", seconds_at_row_);
  archive.transfer("time_spent", watch_);
}

void Recorder::record(const Simulation& simulation, bool last) {
  const Timed timed(watch_);
  if (row_due_.due(simulation.time(), simulation.time_step()) || last) write_row(simulation);
  snapshots_.write_due(simulation);
}

void Recorder::finish(const Simulation& simulation) {
  const Timed timed(watch_);
  if (flow_) flow_->write_profiles(folder_, *simulation.fluid());
}

std::optional<double> Recorder::c_d() const {
  if (!case_.has_fluid() || case_.bodies.empty() || trace().time.empty()) return std::nullopt;
  return trace().column.at(case_.results.body + ".c_d").back();
}

void Recorder::write_row(const Simulation& simulation) {
  const fluid::FluidSolver* fluid = simulation.fluid();
  const std::int64_t updates = fluid ? fluid->statistics().cell_updates : 0;
  mlups_ = 1e-6 * static_cast<double>(updates - updates_at_row_) / (simulation.step_seconds() - seconds_at_row_);
  updates_at_row_ = updates;
  seconds_at_row_ = simulation.step_seconds();

  Row row;
  row.time = simulation.time();
  for (const auto& body : simulation.bodies()) {
    row.bodies.push_back(body->measure(fluid));
    if (fluid) add_coefficients(body->description, row.bodies.back());
  }
  if (flow_) row.flow = flow_->measure(*fluid);
  row.cell_updates = updates;
  row.mlups = mlups_;
  history_.append(row);
}

void Recorder::add_coefficients(const Body& body, BodyRow& row) const {
  const double speed = case_.fluid.reference_velocity;
  const Vec3 c = row.force / (0.5 * case_.fluid.density * speed * speed * body.reference_area);
  row.c_d = c.dot(flow_direction_);
  row.c_l = c - row.c_d * flow_direction_;
}

}  // namespace drogue::app
