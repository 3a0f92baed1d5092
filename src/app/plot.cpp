// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/case.hpp"
#include "app/case_reader.hpp"
#include "core/error.hpp"
#include "io/csv.hpp"
#include "io/plot.hpp"

namespace drogue::app {

namespace {

namespace fs = std::filesystem;

using Column = std::vector<double>;

const io::Axis time_axis{.label = "time [s]"};

const Column& column(const io::CsvTable& table, const std::string& name, const fs::path& folder) {
  const Column* found = table.find(name);
  if (!found) throw InputError(fmt::format("{} has no column {}", (folder / "history.csv").string(), name));
  return *found;
}

Column scaled(Column values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

/// The axis from the values after the start, which is impulsive, with some room.
io::Axis axis_after_start(const std::string& label, const Column& time, const std::vector<io::Curve>& curves,
                          const Case& c) {
  const double start = std::max(c.results.peak_from, 0.02 * time.back());
  double lower = 0.0, upper = 0.0;
  for (const io::Curve& curve : curves) {
    for (std::size_t i = 0; i < time.size(); ++i) {
      if (time[i] < start) continue;
      lower = std::min(lower, curve.y[i]);
      upper = std::max(upper, curve.y[i]);
    }
  }
  if (lower == upper) return {.label = label};
  const double room = 0.1 * (upper - lower);
  return {.label = label, .lower = lower < 0.0 ? lower - room : 0.0, .upper = upper + room};
}

/// One column of the bodies that have it.
io::Plot body_plot(const io::CsvTable& history, const Case& c, const std::string& name, const std::string& label) {
  const Column& time = *history.find("time");
  io::Plot plot{.title = "", .x = time_axis, .y = {}};
  for (const Body& body : c.bodies) {
    const Column* values = history.find(body.name + "." + name);
    if (values) plot.curves.push_back({.label = io::plain(body.name), .x = time, .y = *values});
  }
  plot.y = axis_after_start(label, time, plot.curves, c);
  return plot;
}

io::Plot dissipation_plot(const io::CsvTable& history, const Case& c, const fs::path& folder) {
  const double rate = c.fluid.reference_velocity / c.reference_length;
  const double factor = c.reference_length / std::pow(c.fluid.reference_velocity, 3);
  const Column& time = column(history, "time", folder);
  Column middle;  // of the rows, to which their means belong
  for (std::size_t i = 0; i < time.size(); ++i) middle.push_back(0.5 * rate * (time[i] + (i > 0 ? time[i - 1] : 0.0)));
  io::Plot plot{.title = "", .x = {.label = "t U / L"}, .y = {.label = "dissipation L / U^3", .lower = 0.0}};
  plot.curves = {
      {.label = "loss of kinetic energy", .x = middle, .y = scaled(column(history, "dissipation", folder), factor)},
      {.label = "from the enstrophy",
       .x = scaled(time, rate),
       .y = scaled(column(history, "enstrophy_dissipation", folder), factor),
       .style = io::Style::dashed}};
  const Curve& reference = c.measure.dissipation_reference;
  if (!reference.x.empty()) {
    plot.curves.push_back({.label = "reference", .x = reference.x, .y = reference.y, .style = io::Style::points});
  }
  return plot;
}

io::Plot error_plot(const io::CsvTable& history, const fs::path& folder) {
  io::Plot plot{.title = "", .x = time_axis, .y = {.label = "error of the velocity, relative"}};
  plot.curves = {{.label = "L2 norm", .x = *history.find("time"), .y = column(history, "velocity_error", folder)}};
  return plot;
}

io::Plot profile_plot(const Profile& profile, const fs::path& folder) {
  const fs::path file = folder / fmt::format("profile_{}.csv", profile.name);
  if (!fs::exists(file)) throw InputError(fmt::format("{} is not there: the run did not finish", file.string()));
  const io::CsvTable table = io::read_csv(file);
  const std::string component = fmt::format("u_{}", "xyz"[profile.component]);
  io::Plot plot{.title = io::plain("profile " + profile.name),
                .x = {.label = "distance [m]"},
                .y = {.label = component + " [m/s]"}};
  plot.curves = {{.label = "computed", .x = column(table, "distance", folder), .y = column(table, component, folder)}};
  if (profile.has_reference()) {
    plot.curves.push_back(
        {.label = "reference", .x = profile.reference.x, .y = profile.reference.y, .style = io::Style::points});
  }
  return plot;
}

std::vector<io::Plot> plots_of(const Case& c, const io::CsvTable& history, const fs::path& folder) {
  std::vector<io::Plot> plots;
  if (!c.bodies.empty()) plots.push_back(body_plot(history, c, "c_d", "C_D"));
  if (std::ranges::any_of(c.bodies, is_elastic)) {
    plots.push_back(body_plot(history, c, "centre_dx", "displacement of the centre, x [m]"));
  }
  if (const Body* body = summarised_body(c)) {
    for (const Probe& probe : probes_of(*body)) {
      const bool is_frequency = probe.statistic == "strouhal" || probe.statistic == "period";
      if (!is_frequency) plots.push_back(body_plot(history, c, probe.name, io::plain(probe.name)));
    }
  }
  if (c.measure.energy) plots.push_back(dissipation_plot(history, c, folder));
  if (c.measure.exact_velocity) plots.push_back(error_plot(history, folder));
  for (const Profile& profile : c.measure.profiles) plots.push_back(profile_plot(profile, folder));
  return plots;
}

}  // namespace

std::string plot_run(const fs::path& folder, fs::path picture) {
  const fs::path file = folder / "case.resolved.toml";
  if (!fs::exists(file)) throw InputError(fmt::format("{} holds no run", folder.string()));
  const Case c = read_case(file);
  const io::CsvTable history = io::read_csv(folder / "history.csv");
  if (!history.find("time") || history.columns.front().empty()) {
    throw InputError(fmt::format("{} has no rows yet", (folder / "history.csv").string()));
  }
  const io::Figure figure{.title = io::plain(c.title), .plots = plots_of(c, history, folder), .columns = 2};
  if (figure.plots.empty()) {
    throw InputError(fmt::format("{} has nothing to plot: no body, and nothing in [measure]", folder.string()));
  }
  if (picture.empty()) picture = folder / "plot.png";
  if (picture.extension() != ".png") throw InputError(fmt::format("{}; expected a file .png", picture.string()));
  return io::draw(figure, picture) ? fmt::format("{}\n", picture.string()) : fmt::format("{}\n", io::no_gnuplot);
}

}  // namespace drogue::app
