// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <utility>
#include <vector>

#include "bench/fate.hpp"
#include "bench/result_table.hpp"
#include "io/plot.hpp"

namespace drogue::bench {

namespace {

namespace fs = std::filesystem;

/// One value along a side of a map: how it is called, and what it sets: keys of the case, or its members, where the map
/// goes beyond what a case may ask for.
struct Value {
  std::string label;
  std::vector<std::string> overrides = {};
  std::function<void(app::Case&)> adjust = [](app::Case&) {};
};

struct Side {
  std::string column;  ///< of the table
  std::string label;   ///< in pictures
  std::vector<Value> values;
};

/// One picture: a panel for each value of `panels`, made of rows and columns of runs.
struct Map {
  std::string name, title, file;
  Bound bound;
  Side panels, rows, columns;
  std::string default_panel;
  io::CategoryMap::Frame defaults;  ///< in that panel
};

Side operators(bool quick) {
  Side side{"operator", "", {{"bgk", {"fluid.collision=bgk"}}, {"hrr", {}}}};
  if (quick) return side;
  side.values = {{"bgk", {"fluid.collision=bgk"}},
                 {"rr", {"fluid.collision=rr"}},
                 {"hrr", {}},
                 {"hrr+vreman", {"fluid.eddy_viscosity=vreman"}}};
  return side;
}

Side numbers(const std::string& column, const std::string& label, const std::string& key,
             const std::vector<const char*>& values) {
  Side side{column, label, {}};
  for (const std::string value : values) side.values.push_back({value, {key + "=" + value}});
  return side;
}

/// A flow over Reynolds number and lattice velocity, the default of which is 0.05. Cases of the highest Reynolds number
/// or lattice velocity would be refused: a viscosity that is lost in single precision, a Mach number above 0.3.
Map flow_map(const std::string& name, const std::string& title, Bound bound, bool quick) {
  const auto reynolds = quick ? std::vector<double>{1e2, 1e6} : std::vector<double>{1e2, 1e3, 1e4, 1e5, 1e6, 1e7};
  const auto velocities = quick ? std::vector<double>{0.05, 0.2} : std::vector<double>{0.02, 0.05, 0.1, 0.15, 0.2};
  Side rows{"reynolds", "Reynolds number", {}}, columns{"lattice_velocity", "lattice velocity", {}};
  for (const double re : reynolds) {
    rows.values.push_back({fmt::format("1e{:.0f}", std::log10(re)), {}, [re](app::Case& c) {
                             c.fluid.viscosity = c.fluid.reference_velocity * c.reference_length / re;
                           }});
  }
  for (const double u : velocities) {
    columns.values.push_back({number(u), {}, [u](app::Case& c) { c.fluid.lattice_velocity = u; }});
  }
  const io::CategoryMap::Frame defaults{0, quick ? 0 : 1, static_cast<int>(reynolds.size()), 1};
  return {name, title, name + ".toml", bound, operators(quick), rows, columns, "hrr", defaults};
}

Side inlet_events() {
  const auto event = [](const std::string& speed) {
    return Value{speed, {fmt::format("domain.x_min.velocity=[\"t < 1 ? 1 : {}\", 0, 0]", speed)}};
  };
  return {"event", "inlet after 1 s [m/s]", {event("-1"), event("0"), event("2"), event("3")}};
}

Map sheet_map(const std::string& name, const std::string& title, const Side& rows, const Side& mass, int row,
              int column, int row_count) {
  return {name,
          title,
          name + ".toml",
          Bound::speed,
          {"scheme", "", {{"default", {}}}},
          rows,
          mass,
          "default",
          {row, column, row_count, 1}};
}

std::vector<Map> all_maps(bool quick) {
  const auto density = [](const std::vector<const char*>& values) {
    return numbers("mass_ratio", "density of the sheet over that of the fluid", "body.plate.density", values);
  };
  const auto young = [](const std::vector<const char*>& values) {
    return numbers("young", "Young's modulus [Pa]", "body.plate.material.young", values);
  };
  std::vector<Map> maps{
      flow_map("taylor_green_vortex", "Taylor-Green vortex on 32^3 cells, 30 turnovers", Bound::energy, quick),
      flow_map("shear_layer", "Thin double shear layer on 64^2 cells, 3 turnovers", Bound::energy, quick),
      flow_map("started_plate", "Impulsively started plate, 16 cells wide, 10 widths of travel", Bound::speed, quick)};
  if (quick) {
    maps.push_back(sheet_map("elastic_plate", "Elastic sheet", young({"1e3", "1e4"}), density({"1", "10"}), 0, 0, 1));
    return maps;
  }
  maps.push_back(sheet_map("elastic_plate", "Elastic sheet in a started flow, 3 s",
                           young({"1", "1e1", "1e2", "1e3", "1e4", "1e5", "1e6"}),
                           density({"0", "0.1", "1", "10", "100", "1000"}), 3, 2, 1));
  maps.push_back(sheet_map("sudden_events", "Elastic sheet when the inlet changes at once", inlet_events(),
                           density({"0.1", "1", "1000"}), 0, 1, 4));
  return maps;
}

const std::vector<std::pair<std::string, io::Category>> categories{
    {outcome::survived, {"survived", "#8fc1a9"}},
    {outcome::unbounded, {"out of bounds", "#f0d58c"}},
    {outcome::diverged, {"ended with a message", "#d98880"}},
    {outcome::left, {"left the fine grid", "#b9a3d0"}},
    {outcome::refused, {"refused", "#cccccc"}},
    {outcome::silent, {"silent failure", "#444444"}}};

struct Job {
  const Value *panel, *row, *column;
  Row key() const { return {panel->label, row->label, column->label}; }
};

std::vector<Job> missing_runs(const Map& map, const ResultTable& table) {
  std::vector<Job> jobs;
  for (const Value& panel : map.panels.values) {
    for (const Value& row : map.rows.values) {
      for (const Value& column : map.columns.values) {
        const Job job{&panel, &row, &column};
        if (!table.has(job.key())) jobs.push_back(job);
      }
    }
  }
  return jobs;
}

Fate run(const Map& map, const Job& job, const Options& options) {
  std::vector<std::string> overrides;
  for (const Value* value : {job.panel, job.row, job.column}) {
    overrides.insert(overrides.end(), value->overrides.begin(), value->overrides.end());
  }
  const auto adjust = [&](app::Case& c) {
    job.row->adjust(c);
    job.column->adjust(c);
  };
  if (options.quick) overrides.insert(overrides.end(), {"time.end=0.2", "results.stable_window=[0.1, 0.2]"});
  return follow(repository() / "bench/cases" / map.file, overrides, adjust, map.bound, options.folder);
}

void run_missing(const Map& map, ResultTable& table, const Options& options) {
  const std::vector<Job> jobs = missing_runs(map, table);
  const int count = static_cast<int>(jobs.size());
  std::exception_ptr failure;  // must not leave the loop
  int done = 0;
#pragma omp parallel for schedule(dynamic, 1)
  for (int i = 0; i < count; ++i) {
    try {
      const Fate fate = run(map, jobs[i], options);
      Row row = jobs[i].key();
      row.insert(row.end(), {fate.outcome, number(fate.end), number(fate.largest), number(fate.last), fate.message});
#pragma omp critical(stability_table)
      {
        table.append(row);
        fmt::print("{} {}/{}: {}\n", map.name, ++done, count, fmt::join(row, " "));
        std::fflush(stdout);
      }
    } catch (...) {
#pragma omp critical(stability_table)
      failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

io::CategoryMap::Cell cell_of(const Map& map, const ResultTable& table, const Job& job) {
  const Row key = job.key();
  const auto row =
      std::ranges::find_if(table.rows(), [&](const Row& r) { return std::equal(key.begin(), key.end(), r.begin()); });
  if (row == table.rows().end()) return {-1, ""};
  const std::string& name = table.text(*row, "outcome");
  const auto category = std::ranges::find(categories, name, &std::pair<std::string, io::Category>::first);
  const bool arrived = name == outcome::survived || name == outcome::unbounded;
  const char* shown = map.bound == Bound::energy ? "last" : "largest";
  return {static_cast<int>(category - categories.begin()),
          arrived ? fmt::format("{:.2f}", table.value(*row, shown).value_or(0.0))
                  : fmt::format("t = {:.2f}", table.value(*row, "end").value_or(0.0))};
}

/// "1e5" as a power of ten.
std::string pretty(const std::string& label) {
  return label.starts_with("1e") ? fmt::format("10^{{{}}}", label.substr(2)) : label;
}

io::MapFigure figure_of(const Map& map, const ResultTable& table) {
  const char* note = map.bound == Bound::energy
                         ? "kinetic energy at the end over that at the start, or the time when the run ended"
                         : "largest speed over that of the inlet, or the time when the run ended [s]";
  io::MapFigure figure{map.title, {}, "the defaults", note, {}, 2};
  for (const auto& [name, category] : categories) figure.categories.push_back(category);
  for (const Value& panel : map.panels.values) {
    io::CategoryMap picture{map.panels.values.size() > 1 ? panel.label : "", map.columns.label, map.rows.label, {}, {}};
    for (const Value& column : map.columns.values) picture.columns.push_back(pretty(column.label));
    for (const Value& row : map.rows.values) {
      picture.rows.push_back(pretty(row.label));
      auto& cells = picture.cells.emplace_back();
      for (const Value& column : map.columns.values) cells.push_back(cell_of(map, table, {&panel, &row, &column}));
    }
    if (panel.label == map.default_panel) picture.frame = map.defaults;
    figure.maps.push_back(picture);
  }
  return figure;
}

/// A row for each panel: how many runs had which outcome.
std::vector<Row> counts_of(const Map& map, const ResultTable& table) {
  std::vector<Row> rows;
  for (const Value& panel : map.panels.values) {
    Row row{map.title, panel.label};
    for (const auto& [name, category] : categories) {
      row.push_back(std::to_string(std::ranges::count_if(
          table.rows(), [&](const Row& r) { return r.front() == panel.label && table.text(r, "outcome") == name; })));
    }
    rows.push_back(row);
  }
  return rows;
}

/// How the defaults fared, in a sentence.
std::string verdict_of(const Map& map, const ResultTable& table) {
  const io::CategoryMap::Frame& f = map.defaults;
  int survived = 0;
  for (int row = f.row; row < f.row + f.rows; ++row) {
    for (int column = f.column; column < f.column + f.columns; ++column) {
      Row key{map.default_panel, map.rows.values[row].label, map.columns.values[column].label, outcome::survived};
      if (table.has(key)) ++survived;
    }
  }
  return fmt::format("- {}: {} of {} runs with the defaults survive.\n", map.title, survived, f.rows * f.columns);
}

}  // namespace

std::vector<std::string> stability_parts() {
  std::vector<std::string> names;
  for (const Map& map : all_maps(false)) names.push_back(map.name);
  return names;
}

Report measure_stability(const Options& options) {
  Report report;
  Row header{"flow", "operator"};
  for (const auto& [name, category] : categories) header.push_back(category.label);
  std::vector<Row> counts;
  std::string verdicts;
  for (const Map& map : all_maps(options.quick)) {
    if (!options.wants(map.name)) continue;
    ResultTable table(
        options.folder / fmt::format("stability_{}.csv", map.name),
        {map.panels.column, map.rows.column, map.columns.column, "outcome", "end", "largest", "last", "message"});
    run_missing(map, table, options);
    report.draw(figure_of(map, table), options.folder / fmt::format("stability_{}.png", map.name));
    for (const Row& row : counts_of(map, table)) counts.push_back(row);
    verdicts += verdict_of(map, table);
  }
  report.text = markdown(header, counts) + '\n' + verdicts;
  return report;
}

}  // namespace drogue::bench
