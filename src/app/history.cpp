// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/history.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "app/run_folder.hpp"

namespace drogue::app {

namespace {

template <class T>
struct Source {
  const char *name, *unit;
  double (*value)(const T&);
};

struct BodySource : Source<BodyRow> {
  bool (*applies)(const Body&) = in_flow;
};

using B = const BodyRow&;
constexpr BodySource body_columns[] = {
    {{"force_x", "N", [](B b) { return b.force.x(); }}},
    {{"force_y", "N", [](B b) { return b.force.y(); }}},
    {{"force_z", "N", [](B b) { return b.force.z(); }}},
    {{"torque_x", "N m", [](B b) { return b.torque.x(); }}, is_rigid},
    {{"torque_y", "N m", [](B b) { return b.torque.y(); }}, is_rigid},
    {{"torque_z", "N m", [](B b) { return b.torque.z(); }}, is_rigid},
    {{"c_d", "1", [](B b) { return b.c_d; }}},
    {{"c_l_y", "1", [](B b) { return b.c_l.y(); }}, is_rigid},
    {{"c_l_z", "1", [](B b) { return b.c_l.z(); }}, is_rigid},
    {{"centre_x", "m", [](B b) { return b.centre.x(); }}, is_rigid},
    {{"centre_y", "m", [](B b) { return b.centre.y(); }}, is_rigid},
    {{"centre_z", "m", [](B b) { return b.centre.z(); }}, is_rigid},
    {{"centre_dx", "m", [](B b) { return b.centre.x(); }}, is_elastic},
    {{"centre_dy", "m", [](B b) { return b.centre.y(); }}, is_elastic},
    {{"centre_dz", "m", [](B b) { return b.centre.z(); }}, is_elastic},
    {{"reaction_x", "N", [](B b) { return b.reaction.x(); }}, is_elastic},
    {{"reaction_y", "N", [](B b) { return b.reaction.y(); }}, is_elastic},
    {{"reaction_z", "N", [](B b) { return b.reaction.z(); }}, is_elastic},
    {{"elastic_energy", "J", [](B b) { return b.elastic_energy; }}, is_elastic},
    {{"kinetic_energy", "J", [](B b) { return b.kinetic_energy; }}, is_elastic},
    {{"face_difference_normal", "m/s", [](B b) { return b.face_difference[0]; }}, is_elastic},
    {{"face_difference", "m/s", [](B b) { return b.face_difference[1]; }}, is_elastic},
    {{"thickness_stretch", "1", [](B b) { return b.thickness_stretch; }}, is_elastic},
    {{"plane_stress_thickness", "1", [](B b) { return b.plane_stress[0]; }}, is_elastic},
    {{"plane_stress_misfit", "1", [](B b) { return b.plane_stress[1]; }}, is_elastic},
    {{"J_min", "1", [](B b) { return b.volume_ratio[0]; }}, is_elastic},
    {{"J_max", "1", [](B b) { return b.volume_ratio[1]; }}, is_elastic},
    {{"slip_normal", "m/s", [](B b) { return b.slip_normal; }}, is_elastic_in_flow},
    {{"slip_rms", "m/s", [](B b) { return b.slip_rms; }}},
    {{"slip_max", "m/s", [](B b) { return b.slip_max; }}, is_rigid},
    {{"substeps", "1", [](B b) { return static_cast<double>(b.substeps); }}, is_elastic},
    {{"wake_length", "1", [](B b) { return b.wake_length; }}, has_wake},
};

struct FlowSource : Source<FlowRow> {
  bool (*applies)(const Case&) = [](const Case& c) { return c.has_fluid(); };
};

using F = const FlowRow&;
constexpr FlowSource flow_columns[] = {
    {{"max_mach", "1", [](F f) { return f.max_mach; }}},
    {{"mass_drift", "1", [](F f) { return f.mass_drift; }}},
    {{"kinetic_energy", "m^2/s^2", [](F f) { return f.kinetic_energy; }}, measures_energy},
    {{"dissipation", "m^2/s^3", [](F f) { return f.dissipation; }}, measures_energy},
    {{"enstrophy_dissipation", "m^2/s^3", [](F f) { return f.enstrophy_dissipation; }}, measures_energy},
    {{"velocity_error", "1", [](F f) { return f.velocity_error; }}, measures_error},
    {{"residual", "1", [](F f) { return f.residual; }}, measures_residual},
};

using R = const Row&;
constexpr Source<Row> run_columns[] = {
    {"cell_updates", "1", [](R r) { return static_cast<double>(r.cell_updates); }},
    {"mlups", "1e6/s", [](R r) { return r.mlups; }},
};

std::string number(double value) { return fmt::format("{:.9g}", value); }

}  // namespace

std::vector<History::Column> History::columns_of(const Case& c) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < c.bodies.size(); ++i) {
    for (const BodySource& s : body_columns) {
      if (!s.applies(c.bodies[i])) continue;
      columns.push_back({fmt::format("{}.{}", c.bodies[i].name, s.name), s.unit,
                         [i, value = s.value](R row) { return value(row.bodies[i]); }});
    }
    const auto& probes = probes_of(c.bodies[i]);
    for (std::size_t k = 0; k < probes.size(); ++k) {
      columns.push_back({fmt::format("{}.{}", c.bodies[i].name, probes[k].name), unit_of(probes[k]),
                         [i, k](R row) { return row.bodies[i].probes[k]; }});
    }
  }
  for (const FlowSource& s : flow_columns) {
    if (s.applies(c)) columns.push_back({s.name, s.unit, [value = s.value](R row) { return value(row.flow); }});
  }
  for (std::size_t i = 0; i < c.measure.profiles.size(); ++i) {
    const Profile& p = c.measure.profiles[i];
    if (p.has_reference()) columns.push_back({"rms_" + p.name, "1", [i](R row) { return row.flow.profile_rms[i]; }});
  }
  if (!c.has_fluid()) return columns;
  for (const Source<Row>& s : run_columns) columns.push_back({s.name, s.unit, s.value});
  return columns;
}

History::History(const std::filesystem::path& file, const Case& c) : file_(file), columns_(columns_of(c)) {
  for (const Column& column : columns_) trace_.column[column.name];
}

void History::start() {
  stream_.open(file_);
  std::vector<std::string> header{"time [s]"};
  for (const Column& column : columns_) header.push_back(fmt::format("{} [{}]", column.name, column.unit));
  put_line(header);
}

void History::resume() {
  keep_lines(file_, 1 + static_cast<int>(trace_.time.size()));
  stream_.open(file_, std::ios::app);
}

void History::append(const Row& row) {
  std::vector<std::string> cells{number(row.time)};
  trace_.time.push_back(row.time);
  for (const Column& column : columns_) {
    const double value = column.value(row);
    cells.push_back(number(value));
    trace_.column[column.name].push_back(value);
  }
  put_line(cells);
}

void History::transfer_state(Archive& archive) { archive.transfer("trace", trace_); }

void History::put_line(const std::vector<std::string>& cells) {
  stream_ << fmt::format("{}\n", fmt::join(cells, ",")) << std::flush;
  if (!stream_) throw std::runtime_error(fmt::format("{} cannot be written", file_.string()));
}

}  // namespace drogue::app
