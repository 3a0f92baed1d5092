// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/snapshots.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "app/run_folder.hpp"
#include "io/fluid_snapshot.hpp"
#include "io/series.hpp"

namespace drogue::app {

namespace {

constexpr const char* fluid_series = "fluid.hdf.series";

std::string kind_of(const CoupledBody& body, std::size_t bodies) {
  return bodies == 1 ? "canopy" : "canopy_" + body.description.name;
}

std::string series_of(const std::string& kind) { return kind + ".vtu.series"; }

}  // namespace

Snapshots::Snapshots(const Output& output, const std::filesystem::path& folder)
    : folder_(folder), fluid_due_(output.fluid), canopy_due_(output.canopy) {}

void Snapshots::start() {
  frames_.open(folder_ / "frames.csv");
  frames_ << "kind,index,time [s],file\n" << std::flush;
}

void Snapshots::resume(const Simulation& simulation) {
  const auto& bodies = simulation.bodies();
  const double time = simulation.time(), dt = simulation.time_step();
  io::cut_series(folder_ / fluid_series, time);
  for (const auto& body : bodies) io::cut_series(folder_ / series_of(kind_of(*body, bodies.size())), time);
  keep_lines(folder_ / "frames.csv", 1 + listed_);
  frames_.open(folder_ / "frames.csv", std::ios::app);
  fluid_due_.skip(time, dt);
  canopy_due_.skip(time, dt);
}

void Snapshots::transfer_state(Archive& archive) {
  archive.transfer("fluid_index", fluid_index_);
  archive.transfer("canopy_index", canopy_index_);
  archive.transfer("listed", listed_);
}

void Snapshots::write_due(const Simulation& simulation) {
  const double time = simulation.time(), dt = simulation.time_step();
  if (simulation.fluid() && fluid_due_.due(time, dt)) write_fluid(*simulation.fluid());
  if (!simulation.bodies().empty() && canopy_due_.due(time, dt)) write_bodies(time, simulation.bodies());
}

void Snapshots::write_fluid(const fluid::FluidSolver& fluid) {
  const std::string file = fmt::format("fluid_{:06d}.hdf", fluid_index_);
  io::write_fluid(folder_ / file, fluid);
  list("fluid", fluid_index_++, fluid.time(), fluid_series, file);
}

void Snapshots::write_bodies(double time, const std::vector<std::unique_ptr<CoupledBody>>& bodies) {
  for (const auto& body : bodies) {
    const std::string kind = kind_of(*body, bodies.size());
    const std::string file = fmt::format("{}_{:06d}.vtu", kind, canopy_index_);
    body->write(folder_ / file, time);
    list(kind, canopy_index_, time, series_of(kind), file);
  }
  ++canopy_index_;
}

void Snapshots::list(const std::string& kind, int index, double time, const std::string& series,
                     const std::string& file) {
  io::append_to_series(folder_ / series, file, time);
  frames_ << fmt::format("{},{},{:.9g},{}\n", kind, index, time, file) << std::flush;
  if (!frames_) throw std::runtime_error(fmt::format("{} cannot be written", (folder_ / "frames.csv").string()));
  ++listed_;
}

}  // namespace drogue::app
