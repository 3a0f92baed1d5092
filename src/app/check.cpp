// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "app/case_reader.hpp"
#include "app/inspect.hpp"
#include "app/scene.hpp"

namespace drogue::app {

namespace {

constexpr double bytes_per_cell = 2.0 * 28.0;  // two buffers of ten moments
constexpr double usual_mlups = 200.0;          // of two cores

std::string fluid_text(const Case& c) {
  const fluid::Specification& f = c.fluid;
  const double length = c.reference_length;
  std::string text =
      fmt::format("fluid   Mach {:.3g} ({:.3g} m/s is {:.3g} cells a step), viscosity {:.4g} m^2/s",
                  std::sqrt(3.0) * f.lattice_velocity, f.reference_velocity, f.lattice_velocity, f.viscosity);
  if (length > 0.0) text += fmt::format(", Reynolds number {:.4g}", f.reference_velocity * length / f.viscosity);
  return text + "\n";
}

std::string grid_text(const Case& c, const amr::Forest& forest) {
  std::string text = fmt::format("\n{:>7} {:>13} {:>12} {:>12} {:>12} {:>9}\n", "level", "spacing [m]", "step [s]",
                                 "tau", "cells", "blocks");
  std::int64_t cells = 0;
  for (int level = 0; level < forest.levels(); ++level) {
    text += fmt::format("{:>7} {:>13.6g} {:>12.4g} {:>12.7f} {:>12} {:>9}\n", level, forest.spacing(level),
                        time_step(c, level), relaxation_time(c, level), forest.cells(level),
                        forest.range(level, amr::Kind::leaf).size());
    cells += forest.cells(level);
  }
  return text + fmt::format("{:>7} {:>13} {:>12} {:>12} {:>12}\n\n", "all", "", "", "", cells);
}

std::string cost_text(const Case& c, const amr::Forest& forest) {
  double updates_a_step = 0.0;
  for (int level = 0; level < forest.levels(); ++level) {
    updates_a_step += std::ldexp(static_cast<double>(forest.cells(level)), level);
  }
  const double steps = std::ceil(c.end / time_step(c, 0) * (1.0 - 1e-9));
  const double memory = bytes_per_cell * amr::block_cells * forest.size();
  return fmt::format(
      "run     {} s in {} coarse steps, {:.3g} cell updates: {:.0f} s at {:.0f} MLUPS; about {:.2f} GiB\n", c.end,
      steps, steps * updates_a_step, steps * updates_a_step / (1e6 * usual_mlups), usual_mlups,
      memory / std::pow(1024.0, 3));
}

}  // namespace

std::string check_report(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  const Case c = read_case(path, overrides);
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("drogue-check-{}", c.name);
  const Meshes meshes = load_meshes(c, folder);
  std::optional<amr::Forest> forest;
  if (c.has_fluid()) forest.emplace(make_forest(c, meshes));
  const auto bodies = make_bodies(c, meshes, forest ? &*forest : nullptr);
  const auto touching = make_touching(c, bodies);

  std::string text = fmt::format("{}\n\n", c.title.empty() ? c.name : c.title);
  if (forest) text += fluid_text(c) + grid_text(c, *forest) + cost_text(c, *forest);
  for (const auto& body : bodies) text += body->report(c);
  return text + fmt::format("{} is in order\n", c.file.string());
}

}  // namespace drogue::app
