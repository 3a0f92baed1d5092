// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/history.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "app/run_folder.hpp"

namespace drogue::app {

namespace {

template <class T>
struct Column {
  const char *name, *unit;
  double (*value)(const T&);
};

struct BodyColumn : Column<BodyRow> {
  bool (*applies)(const Body&) = is_any;
};

using B = const BodyRow&;
constexpr BodyColumn body_columns[] = {
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
    {{"slip_normal", "m/s", [](B b) { return b.slip_normal; }}, is_elastic},
    {{"slip_rms", "m/s", [](B b) { return b.slip_rms; }}},
    {{"slip_max", "m/s", [](B b) { return b.slip_max; }}, is_rigid},
    {{"substeps", "1", [](B b) { return static_cast<double>(b.substeps); }}, is_elastic},
    {{"wake_length", "1", [](B b) { return b.wake_length; }}, has_wake},
};

using R = const Row&;
constexpr Column<Row> run_columns[] = {
    {"max_mach", "1", [](R r) { return r.max_mach; }},
    {"mass_drift", "1", [](R r) { return r.mass_drift; }},
    {"cell_updates", "1", [](R r) { return static_cast<double>(r.cell_updates); }},
    {"mlups", "1e6/s", [](R r) { return r.mlups; }},
};

std::string number(double value) { return fmt::format("{:.9g}", value); }

}  // namespace

History::History(const std::filesystem::path& file, const std::vector<Body>& bodies)
    : file_(file), bodies_(bodies), traces_(bodies.size()) {}

void History::start() {
  stream_.open(file_);
  std::vector<std::string> header{"time [s]"};
  for (const Body& body : bodies_) {
    for (const auto& column : body_columns) {
      if (column.applies(body)) header.push_back(fmt::format("{}.{} [{}]", body.name, column.name, column.unit));
    }
  }
  for (const auto& column : run_columns) header.push_back(fmt::format("{} [{}]", column.name, column.unit));
  put_line(header);
}

void History::resume() {
  keep_lines(file_, 1 + rows_);
  stream_.open(file_, std::ios::app);
}

void History::append(const Row& row) {
  std::vector<std::string> cells{number(row.time)};
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    for (const auto& column : body_columns) {
      if (column.applies(bodies_[i])) cells.push_back(number(column.value(row.bodies[i])));
    }
  }
  for (const auto& column : run_columns) cells.push_back(number(column.value(row)));
  put_line(cells);
  ++rows_;

  for (std::size_t i = 0; i < traces_.size(); ++i) {
    const BodyRow& body = row.bodies.at(i);
    traces_[i].time.push_back(row.time);
    traces_[i].c_d.push_back(body.c_d);
    traces_[i].centre_dx.push_back(body.centre.x());
    traces_[i].slip_normal.push_back(body.slip_normal);
    traces_[i].face_difference.push_back(body.face_difference[1]);
    traces_[i].slip_rms.push_back(body.slip_rms);
    traces_[i].wake_length.push_back(body.wake_length);
  }
}

void History::transfer_state(Archive& archive) {
  archive.transfer("rows", rows_);
  for (std::size_t i = 0; i < traces_.size(); ++i) archive.transfer("trace_" + bodies_[i].name, traces_[i]);
}

void History::put_line(const std::vector<std::string>& cells) {
  stream_ << fmt::format("{}\n", fmt::join(cells, ",")) << std::flush;
  if (!stream_) throw std::runtime_error(fmt::format("{} cannot be written", file_.string()));
}

}  // namespace drogue::app
