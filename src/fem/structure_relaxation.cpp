// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium by dynamic relaxation with kinetic damping (Cundall 1976; Barnes, Int. J. Space Struct. 14 (1999) 89):
// nodes with fictitious masses, chosen so that a step of 1 is stable, fall towards equilibrium without damping;
// whenever the kinetic energy passes a peak, it is taken away. No matrix, so slack cables, wrinkled membranes and
// sheets that start flat need no special care.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "fem/structure_data.hpp"

namespace drogue::fem {
namespace {

constexpr int refresh_interval = 100;  // iterations between estimates of the stiffness

}  // namespace

std::vector<double> Structure::Data::fictitious_masses(const std::vector<double>& least_stiffness) {
  // With a mass of a quarter of the stiffness a step of 1 is at the limit; pressure adds a little stiffness of its own.
  constexpr double safety = 1.5;
  std::vector<double> mass = elements.nodal_stiffness(x);
  for (std::size_t node = 0; node < mass.size(); ++node) {
    double stiffness = std::max(mass[node], least_stiffness[node]);
    for (const Hold* hold : hold_of_node[node]) {
      if (hold && !hold->rigid) stiffness += elements.nodal_volume()[node] * hold->stiffness;
    }
    mass[node] = 0.25 * safety * stiffness;
  }
  return mass;
}

int Structure::Data::relax(double time, const EquilibriumOptions& asked) {
  const std::vector<Vec3> way = way_of_held(x);
  for (std::size_t node = 0; node < x.size(); ++node) x[node] += way[node];
  const std::vector<double> least_stiffness = elements.nodal_stiffness(mesh.nodes);
  std::vector<double> mass;
  std::vector<Vec3> last_change(x.size(), Vec3::Zero());
  double energy_before = 0.0, scale = 0.0, residual = INFINITY;
  for (int iteration = 0; iteration < asked.most_iterations; ++iteration) {
    if (iteration % refresh_interval == 0) mass = fictitious_masses(least_stiffness);
    const Balance now = balance(x, own_weight());
    if (!now.inside) report_divergence(time);
    const double left = norm(now.left);
    scale = std::max(now.scale, iteration == 0 ? left : scale);
    residual = scale > 0.0 ? left / scale : 0.0;
    if (residual <= asked.tolerance) {
      reaction = now.reaction;
      return iteration;
    }
    double energy = 0.0;
    for (std::size_t node = 0; node < x.size(); ++node) {
      v[node] += now.left[node] / mass[node];
      energy += 0.5 * mass[node] * v[node].squaredNorm();
    }
    const bool past_peak = energy < energy_before;
    energy_before = past_peak ? 0.0 : energy;
    for (std::size_t node = 0; node < x.size(); ++node) {
      // The peak lies, by linear interpolation of the energy, about half a step back.
      if (past_peak) {
        x[node] -= 0.5 * last_change[node];
        v[node].setZero();
      } else {
        last_change[node] = v[node];
        x[node] += v[node];
      }
    }
  }
  report_imbalance(time, residual, asked.tolerance);
}

}  // namespace drogue::fem
