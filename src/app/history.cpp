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

using B = const BodyRow&;
constexpr Column<BodyRow> body_columns[] = {
    {"force_x", "N", [](B b) { return b.force.x(); }},
    {"force_y", "N", [](B b) { return b.force.y(); }},
    {"force_z", "N", [](B b) { return b.force.z(); }},
    {"c_d", "1", [](B b) { return b.c_d; }},
    {"centre_dx", "m", [](B b) { return b.centre.x(); }},
    {"centre_dy", "m", [](B b) { return b.centre.y(); }},
    {"centre_dz", "m", [](B b) { return b.centre.z(); }},
    {"reaction_x", "N", [](B b) { return b.reaction.x(); }},
    {"reaction_y", "N", [](B b) { return b.reaction.y(); }},
    {"reaction_z", "N", [](B b) { return b.reaction.z(); }},
    {"elastic_energy", "J", [](B b) { return b.elastic_energy; }},
    {"kinetic_energy", "J", [](B b) { return b.kinetic_energy; }},
    {"face_difference_normal", "m/s", [](B b) { return b.face_difference[0]; }},
    {"face_difference", "m/s", [](B b) { return b.face_difference[1]; }},
    {"thickness_stretch", "1", [](B b) { return b.thickness_stretch; }},
    {"plane_stress_thickness", "1", [](B b) { return b.plane_stress[0]; }},
    {"plane_stress_misfit", "1", [](B b) { return b.plane_stress[1]; }},
    {"J_min", "1", [](B b) { return b.volume_ratio[0]; }},
    {"J_max", "1", [](B b) { return b.volume_ratio[1]; }},
    {"slip_normal", "m/s", [](B b) { return b.slip[0]; }},
    {"slip_rms", "m/s", [](B b) { return b.slip[1]; }},
    {"substeps", "1", [](B b) { return static_cast<double>(b.substeps); }},
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

History::History(const std::filesystem::path& file, const std::vector<std::string>& bodies)
    : file_(file), bodies_(bodies), traces_(bodies.size()) {}

void History::start() {
  stream_.open(file_);
  std::vector<std::string> header{"time [s]"};
  for (const std::string& body : bodies_) {
    for (const auto& column : body_columns) header.push_back(fmt::format("{}.{} [{}]", body, column.name, column.unit));
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
  for (const BodyRow& body : row.bodies) {
    for (const auto& column : body_columns) cells.push_back(number(column.value(body)));
  }
  for (const auto& column : run_columns) cells.push_back(number(column.value(row)));
  put_line(cells);
  ++rows_;

  for (std::size_t i = 0; i < traces_.size(); ++i) {
    const BodyRow& body = row.bodies.at(i);
    traces_[i].time.push_back(row.time);
    traces_[i].c_d.push_back(body.c_d);
    traces_[i].centre_dx.push_back(body.centre.x());
    traces_[i].slip_normal.push_back(body.slip[0]);
    traces_[i].face_difference.push_back(body.face_difference[1]);
  }
}

void History::transfer_state(Archive& archive) {
  archive.transfer("rows", rows_);
  for (std::size_t i = 0; i < traces_.size(); ++i) archive.transfer("trace_" + bodies_[i], traces_[i]);
}

void History::put_line(const std::vector<std::string>& cells) {
  stream_ << fmt::format("{}\n", fmt::join(cells, ",")) << std::flush;
  if (!stream_) throw std::runtime_error(fmt::format("{} cannot be written", file_.string()));
}

}  // namespace drogue::app
