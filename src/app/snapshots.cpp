// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/snapshots.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "io/canopy.hpp"
#include "io/fluid_snapshot.hpp"
#include "io/series.hpp"

namespace drogue::app {

Snapshots::Snapshots(const Output& output, const std::filesystem::path& folder)
    : folder_(folder), frames_(folder / "frames.csv"), fluid_due_(output.fluid), canopy_due_(output.canopy) {
  frames_ << "kind,index,time [s],file\n" << std::flush;
}

void Snapshots::write_due(const fluid::FluidSolver& fluid, const std::vector<std::unique_ptr<CoupledBody>>& bodies) {
  const double time = fluid.time(), dt = fluid.coarse_dt();
  if (fluid_due_.due(time, dt)) write_fluid(fluid);
  if (!bodies.empty() && canopy_due_.due(time, dt)) write_bodies(time, bodies);
}

void Snapshots::write_fluid(const fluid::FluidSolver& fluid) {
  const std::string file = fmt::format("fluid_{:06d}.hdf", fluid_index_);
  io::write_fluid(folder_ / file, fluid);
  list("fluid", fluid_index_++, fluid.time(), "fluid.hdf.series", file);
}

void Snapshots::write_bodies(double time, const std::vector<std::unique_ptr<CoupledBody>>& bodies) {
  for (const auto& body : bodies) {
    const std::string kind = bodies.size() == 1 ? "canopy" : "canopy_" + body->description.name;
    const std::string file = fmt::format("{}_{:06d}.vtu", kind, canopy_index_);
    const fem::Structure& structure = body->structure;
    io::write_canopy(folder_ / file, structure.mesh(), structure.position(), structure.velocity(), {}, time);
    list(kind, canopy_index_, time, kind + ".vtu.series", file);
  }
  ++canopy_index_;
}

void Snapshots::list(const std::string& kind, int index, double time, const std::string& series,
                     const std::string& file) {
  io::append_to_series(folder_ / series, file, time);
  frames_ << fmt::format("{},{},{:.9g},{}\n", kind, index, time, file) << std::flush;
  if (!frames_) throw std::runtime_error(fmt::format("{} cannot be written", (folder_ / "frames.csv").string()));
}

}  // namespace drogue::app
