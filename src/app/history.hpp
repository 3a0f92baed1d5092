// SPDX-License-Identifier: GPL-3.0-or-later
// history.csv: one row per output interval. A column is added in history.cpp, in one of its lists.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "app/results.hpp"
#include "core/types.hpp"

namespace drogue::app {

/// What a row tells of a body. Forces are means since the row before, the rest is at the row's time.
struct BodyRow {
  Vec3 force = Vec3::Zero();   ///< by the fluid [N]
  Vec3 torque = Vec3::Zero();  ///< by the fluid about the centre [N m]; of a rigid body
  double c_d = 0.0;
  Vec3 c_l = Vec3::Zero();                            ///< what is across the flow
  Vec3 centre = Vec3::Zero();                         ///< displacement of an elastic body, place of a rigid one [m]
  Vec3 reaction = Vec3::Zero();                       ///< of the holds on the body [N]
  double elastic_energy = 0.0, kinetic_energy = 0.0;  ///< [J]
  std::array<double, 2> face_difference{};  ///< velocity of one face less the other's: along normal, in full [m/s]
  double thickness_stretch = 1.0;
  std::array<double, 2> plane_stress{1.0, 0.0};  ///< fem::Structure::plane_stress_comparison
  std::array<double, 2> volume_ratio{1.0, 1.0};  ///< smallest and largest J
  double slip_normal = 0.0;                      ///< of the fluid past the body, mean along the normal [m/s]
  double slip_rms = 0.0, slip_max = 0.0;         ///< [m/s]
  int substeps = 0;
  std::vector<double> probes;  ///< of the case, in its order
  double wake_length = 0.0;    ///< in widths of the body
};

/// What a row tells of the flow; what the case does not ask for is zero.
struct FlowRow {
  double max_mach = 0.0;
  double mass_drift = 0.0;             ///< relative, since the start
  double kinetic_energy = 0.0;         ///< per mass [m^2/s^2]
  double dissipation = 0.0;            ///< what the energy lost, mean since the row before [m^2/s^3]
  double enstrophy_dissipation = 0.0;  ///< 2 nu times the enstrophy [m^2/s^3]
  double velocity_error = 0.0;         ///< relative
  double residual = 0.0;               ///< over the amplitude
  std::vector<double> profile_rms;     ///< over the reference velocity, profile by profile
};

struct Row {
  double time = 0.0;  ///< [s]
  std::vector<BodyRow> bodies;
  FlowRow flow;
  std::int64_t cell_updates = 0;  ///< since the start
  double mlups = 0.0;             ///< million cell updates a second, since the row before
};

/// Every member that writes throws std::runtime_error naming the file.
class History {
 public:
  History(const std::filesystem::path& file, const Case& c);

  void start();   ///< writes the header
  void resume();  ///< goes on after the rows of the state that was restored; later ones are removed
  void append(const Row& row);
  /// The rows so far.
  const Trace& trace() const { return trace_; }

  void transfer_state(Archive& archive);

 private:
  struct Column {
    std::string name, unit;
    std::function<double(const Row&)> value;
  };
  static std::vector<Column> columns_of(const Case& c);
  void put_line(const std::vector<std::string>& cells);

  std::filesystem::path file_;
  std::ofstream stream_;
  std::vector<Column> columns_;
  Trace trace_;
};

}  // namespace drogue::app
