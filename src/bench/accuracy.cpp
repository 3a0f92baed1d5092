// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "app/run.hpp"
#include "app/summary.hpp"
#include "bench/result_table.hpp"
#include "bench/work_precision.hpp"
#include "core/error.hpp"

namespace drogue::bench {

namespace {

namespace fs = std::filesystem;
using Results = std::map<std::string, double>;

/// A flow whose solution is known.
struct Study {
  std::string name, title, error_label;
  std::vector<int> cells;                                   ///< across what the flow is measured by
  std::function<std::vector<std::string>(int cells)> grid;  ///< overrides of the case
  std::vector<double> lattice_velocities;
  std::function<double(const Results&)> error;
  double target;                   ///< error that the recommended setting keeps
  std::vector<std::string> quick;  ///< overrides that shorten it
};

std::vector<std::string> uniform_grid(int n) {
  return {fmt::format("grid.coarsest=1/{}", n), fmt::format("grid.finest=1/{}", n)};
}

Study taylor_green() {
  const auto grid = [](int n) {
    std::vector<std::string> overrides = uniform_grid(n);
    overrides.push_back(fmt::format("domain.upper=[1, 1, \"16/{}\"]", n));
    return overrides;
  };
  return {"taylor_green",
          "Taylor-Green vortex, Re = 100, exact",
          "L2 error of the velocity",
          {32, 64, 128},
          grid,
          {0.01, 0.02, 0.05, 0.1},
          [](const Results& r) { return r.at("velocity_error"); },
          1e-3,
          {"time.end=0.1"}};
}

Study cavity() {
  const auto error = [](const Results& r) { return std::hypot(r.at("rms_u"), r.at("rms_v")) / std::sqrt(2.0); };
  return {"cavity_re1000",
          "Lid-driven cube, Re = 1000",
          "rms error of both centre lines over the lid speed",
          {32, 64, 96},
          uniform_grid,
          {0.05, 0.1, 0.15},
          error,
          0.01,
          {"time.end=0.5"}};
}

Study sphere() {
  const auto grid = [](int n) {
    const int coarsest = n % 3 == 0 ? 3 : 2;
    return std::vector{fmt::format("grid.coarsest=1/{}", coarsest), fmt::format("grid.finest=1/{}", n),
                       fmt::format("grid.region.1.spacing=2/{}", n), fmt::format("grid.region.2.spacing=4/{}", n)};
  };
  constexpr double reference = 1.087;  // Johnson & Patel, J. Fluid Mech. 378 (1999) 19
  const auto error = [](const Results& r) { return std::abs(r.at("cd_stable") / reference - 1.0); };
  return {"sphere_re100",
          "Sphere, Re = 100",
          "relative error of C_D",
          {8, 12, 16, 24, 32},
          grid,
          {0.05, 0.1, 0.15},
          error,
          0.02,
          {"time.end=0.5", "results.stable_window=[0.25, 0.5]", "results.peak_from=0"}};
}

std::vector<Study> all_studies(bool quick) {
  std::vector<Study> studies{taylor_green(), cavity(), sphere()};
  for (Study& study : studies) {
    if (!quick) {
      study.quick.clear();
      continue;
    }
    study.cells = {study.cells.front()};
    study.lattice_velocities = {0.05, 0.1};
  }
  return studies;
}

struct Setting {
  std::string op;
  double lattice_velocity;
  int cells;
  Row key() const { return {op, number(lattice_velocity), std::to_string(cells)}; }
};

std::vector<Setting> settings_of(const Study& study) {
  std::vector<Setting> settings;
  for (const int cells : study.cells) {  // cheap ones first
    for (const char* op : {"bgk", "rr", "hrr"}) {
      for (const double u : study.lattice_velocities) settings.push_back({op, u, cells});
    }
  }
  return settings;
}

/// The row of a setting: its key, error, seconds of stepping, cell updates, rate, and why it failed if it did. Throws
/// InputError if the user interrupted it.
Row run(const Study& study, const Setting& setting, const Options& options) {
  app::RunOptions run;
  run.path = repository() / "cases" / study.name;
  run.folder = options.folder / "runs" / fmt::format("{}-{}", study.name, fmt::join(setting.key(), "-"));
  run.overrides = study.grid(setting.cells);
  run.overrides.insert(run.overrides.end(), study.quick.begin(), study.quick.end());
  run.overrides.push_back("fluid.collision=" + setting.op);
  run.overrides.push_back("fluid.lattice_velocity=" + number(setting.lattice_velocity));
  run.overrides.insert(run.overrides.end(), {"output.checkpoint=0", "output.fluid=0"});
  run.force = run.quiet = true;
  Row row = setting.key();
  try {
    if (app::run_case(run) != 0) throw InputError("interrupted; the same command goes on from here");
    const app::RunNumbers numbers = app::read_numbers(run.folder / "summary.json");
    row.insert(row.end(),
               {number(study.error(numbers.results)), number(numbers.step_seconds), number(numbers.cell_updates),
                number(1e-6 * numbers.cell_updates / numbers.step_seconds), ""});
  } catch (const Diverged& error) {
    row.insert(row.end(), {"", "", "", "", error.what()});
  }
  return row;
}

std::string family_of(const ResultTable& table, const Row& row) {
  return fmt::format("{}, {}", table.text(row, "operator"), table.text(row, "lattice_velocity"));
}

/// Points of the runs that finished.
std::vector<Point> points_of(const ResultTable& table) {
  std::vector<Point> points;
  for (const Row& row : table.rows()) {
    const auto error = table.value(row, "error"), seconds = table.value(row, "seconds");
    if (!error || !seconds) continue;
    points.push_back({family_of(table, row), static_cast<int>(*table.value(row, "cells")), *seconds, *error});
  }
  return points;
}

io::Plot plot_of(const Study& study, const std::vector<Point>& points) {
  io::Plot plot{
      study.title, {"time stepping [s]", io::Scale::logarithmic}, {study.error_label, io::Scale::logarithmic}};
  int colour = 0;
  for (const char* op : {"bgk", "rr", "hrr"}) {
    int mark = 0;
    for (const double u : study.lattice_velocities) {
      io::Curve curve{fmt::format("{}, {}", op, number(u)), {}, {}, io::Style::line_and_points, mark++, colour};
      for (const Point& point : points) {
        if (point.family != curve.label) continue;
        curve.x.push_back(point.seconds);
        curve.y.push_back(point.error);
      }
      plot.curves.push_back(curve);
    }
    ++colour;
  }
  constexpr int grey = 7;
  io::Curve front{"Pareto front", {}, {}, io::Style::dashed, {}, grey};
  for (const int i : pareto_front(points)) {
    front.x.push_back(points[i].seconds);
    front.y.push_back(points[i].error);
  }
  plot.curves.push_back(front);
  if (const auto best = cheapest_within(points, study.target)) {
    plot.curves.push_back({"recommended", {points[*best].seconds}, {points[*best].error}, io::Style::ring, {}, grey});
  }
  return plot;
}

/// The front as a table, and the recommended setting in a sentence.
std::string text_of(const Study& study, const std::vector<Point>& points) {
  std::vector<Row> rows;
  for (const int i : pareto_front(points)) {
    const Point& p = points[i];
    rows.push_back(
        {p.family, std::to_string(p.resolution), fmt::format("{:.3g}", p.seconds), fmt::format("{:.3g}", p.error)});
  }
  std::string text = fmt::format("### {}\n\n", study.title);
  text += markdown({"operator, lattice velocity", "cells across", "time [s]", study.error_label}, rows);
  const auto best = cheapest_within(points, study.target);
  if (!best) return text + fmt::format("\nNo setting keeps an error of {:g}.\n", study.target);
  const Point& p = points[*best];
  return text + fmt::format(
                    "\nThe cheapest setting that keeps an error of {:g}, as do all finer grids with it: {}, {} cells "
                    "across, {:.3g} s (error {:.3g}).\n",
                    study.target, p.family, p.resolution, p.seconds, p.error);
}

}  // namespace

std::vector<std::string> accuracy_parts() {
  std::vector<std::string> names;
  for (const Study& study : all_studies(false)) names.push_back(study.name);
  return names;
}

Report measure_accuracy(const Options& options) {
  Report report;
  io::Figure figure{"Error against run time", {}, 2};
  for (const Study& study : all_studies(options.quick)) {
    if (!options.wants(study.name)) continue;
    ResultTable table(
        options.folder / fmt::format("accuracy_{}.csv", study.name),
        {"operator", "lattice_velocity", "cells", "error", "seconds", "cell_updates", "mlups", "message"});
    for (const Setting& setting : settings_of(study)) {
      if (table.has(setting.key())) continue;
      table.append(run(study, setting, options));
      fmt::print("{} {}\n", study.name, fmt::join(table.rows().back(), " "));
      std::fflush(stdout);
    }
    const std::vector<Point> points = points_of(table);
    figure.plots.push_back(plot_of(study, points));
    report.text += text_of(study, points) + "\n";
  }
  report.draw(figure, options.folder / "accuracy.png");
  return report;
}

}  // namespace drogue::bench
