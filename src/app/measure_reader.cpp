// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/measure_reader.hpp"

#include <fmt/format.h>

#include "app/value.hpp"
#include "core/error.hpp"
#include "io/csv.hpp"

namespace drogue::app {

namespace {

namespace fs = std::filesystem;

/// Two columns of numbers, named in the case by a file; empty if it is not.
Curve read_curve(Section& section, const std::string& name, const std::string& doc) {
  const auto file = section.find<fs::path>(name, {.doc = doc});
  if (!file) return {};
  try {
    const io::CsvTable table = io::read_csv(*file);
    if (table.columns.size() == 2 && !table.columns[0].empty()) return {table.columns[0], table.columns[1]};
  } catch (const InputError& error) {
    section.fail(name, fmt::format("= \"{}\": {}", file->string(), error.what()));
  }
  section.fail(name, fmt::format("= \"{}\" holds no curve; expected two columns with a name each", file->string()));
  return {};
}

Profile read_profile(Section& section) {
  Profile p;
  p.name = section.get<std::string>("name", {.doc = "of the file profile_NAME.csv and of the result rms_NAME"});
  p.from = section.get<Vec3>("from", {.unit = "m", .doc = "where the line begins"});
  p.to = section.get<Vec3>("to", {.unit = "m", .doc = "where it ends"});
  p.points = section.get<int>(
      "points", {.doc = "along the line, both ends included", .fallback = 101, .range = {.min = 2, .max = 100000}});
  p.component = section.choose("component", axes, {.doc = "of the velocity, for reference", .fallback = "x"});
  p.reference = read_curve(section, "reference",
                           "CSV of published values: distance from the beginning [m], component of the velocity [m/s]; "
                           "makes the column and the result rms_NAME, over the reference velocity");
  return p;
}

std::optional<Residual> read_residual(Section section) {
  const auto box =
      section.find<Box>("box", {.unit = "m",
                                .doc = "where the fluid should be undisturbed again; makes the column and the "
                                       "result residual, the largest deviation there over the amplitude"});
  if (!box && !section.describing()) return std::nullopt;
  Residual r{box.value_or(Box{})};
  r.of_pressure = section.choose<bool>("of", {{"velocity", false}, {"pressure", true}},
                                       {.doc = "what deviates", .fallback = "velocity"});
  if (section.describing() || !r.of_pressure)
    r.velocity = section.get<Vec3>("undisturbed", {.unit = "m/s", .doc = "velocity", .fallback = Vec3(0.0, 0.0, 0.0)});
  r.amplitude = section.get<double>("amplitude", {.doc = "of what has passed, in m/s or Pa", .range = positive});
  return r;
}

}  // namespace

Measure read_measure(Section section) {
  Measure m;
  m.energy =
      section.get<bool>("energy", {.doc = "columns kinetic_energy, dissipation and enstrophy_dissipation; results "
                                          "dissipation_peak and dissipation_peak_time in units of "
                                          "fluid.reference_velocity and fluid.reference_length",
                                   .fallback = false});
  m.dissipation_reference = read_curve(section, "dissipation_reference",
                                       "CSV of a published dissipation over time, in the units of dissipation_peak, "
                                       "for `plot`");
  m.exact_velocity = section.find<Formulas>(
      "exact_velocity", {.unit = "m/s",
                         .doc = "a solution the flow should have: column and result velocity_error, the "
                                "relative L2 norm of the difference"});
  m.residual = read_residual(section.section("residual", "what a wave or an eddy leaves behind"));
  section.each("profile", "a line along which the flow is sampled at the end of the run",
               [&](Section& profile) { m.profiles.push_back(read_profile(profile)); });
  return m;
}

}  // namespace drogue::app
