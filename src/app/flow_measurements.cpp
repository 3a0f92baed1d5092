// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/flow_measurements.hpp"

#include <fmt/format.h>

#include <cmath>

#include "fluid/averages.hpp"
#include "fluid/deviation.hpp"
#include "fluid/probe.hpp"
#include "io/csv.hpp"

namespace drogue::app {

namespace {

/// Root mean square of what the flow differs from the reference of a profile [m/s]; the points lie in the domain.
double rms_difference(const Profile& profile, const fluid::FluidSolver& fluid) {
  fluid::Probe probe(fluid);
  const auto& [distance, value] = profile.reference;
  double sum = 0.0;
  for (std::size_t i = 0; i < distance.size(); ++i) {
    sum += std::pow(probe(profile.at(distance[i])).value().velocity[profile.component] - value[i], 2);
  }
  return std::sqrt(sum / static_cast<double>(distance.size()));
}

double measured(const Residual& r, const fluid::FluidSolver& fluid) {
  const double deviation = r.of_pressure ? fluid::largest_pressure(fluid, r.box)
                                         : fluid::largest_velocity_deviation(fluid, r.box, r.velocity);
  return deviation / r.amplitude;
}

}  // namespace

FlowMeasurements::FlowMeasurements(const Case& c, const fluid::FluidSolver& fluid)
    : case_(c), mass_at_start_(fluid.mass_and_momentum()[0]) {
  if (c.measure.energy) energy_before_ = fluid::kinetic_energy(fluid);
}

FlowRow FlowMeasurements::measure(const fluid::FluidSolver& fluid) {
  const Measure& m = case_.measure;
  FlowRow row;
  row.max_mach = fluid.statistics().max_mach;
  row.mass_drift = fluid.mass_and_momentum()[0] / mass_at_start_ - 1.0;
  if (m.energy) {
    row.kinetic_energy = fluid::kinetic_energy(fluid);
    row.dissipation = (energy_before_ - row.kinetic_energy) / (fluid.time() - time_before_);
    row.enstrophy_dissipation = 2.0 * case_.fluid.viscosity * fluid::enstrophy(fluid);
    energy_before_ = row.kinetic_energy;
    time_before_ = fluid.time();
  }
  if (m.exact_velocity) row.velocity_error = fluid::relative_velocity_error(fluid, *m.exact_velocity);
  if (m.residual) row.residual = measured(*m.residual, fluid);
  for (const Profile& p : m.profiles) {
    row.profile_rms.push_back(p.has_reference() ? rms_difference(p, fluid) / case_.fluid.reference_velocity : 0.0);
  }
  return row;
}

void FlowMeasurements::write_profiles(const std::filesystem::path& folder, const fluid::FluidSolver& fluid) const {
  for (const Profile& p : case_.measure.profiles) {
    fluid::Probe probe(fluid);
    io::CsvTable table{
        {"distance [m]", "x [m]", "y [m]", "z [m]", "u_x [m/s]", "u_y [m/s]", "u_z [m/s]", "pressure [Pa]"},
        std::vector<std::vector<double>>(8)};
    for (int i = 0; i < p.points; ++i) {
      const double distance = (p.to - p.from).norm() * i / (p.points - 1);
      const Vec3 place = p.at(distance);
      const auto [velocity, pressure] = probe(place).value();
      const std::array row{distance,     place.x(),    place.y(),    place.z(),
                           velocity.x(), velocity.y(), velocity.z(), pressure};
      for (std::size_t k = 0; k < row.size(); ++k) table.columns[k].push_back(row[k]);
    }
    io::write_csv(folder / fmt::format("profile_{}.csv", p.name), table);
  }
}

void FlowMeasurements::transfer_state(Archive& archive) {
  archive.transfer("mass_at_start", mass_at_start_);
  archive.transfer("time_before", time_before_);
  archive.transfer("energy_before", energy_before_);
}

}  // namespace drogue::app
