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

double squared_norm(const std::vector<Vec3>& field) {
  double sum = 0.0;
  for (const Vec3& value : field) sum += value.squaredNorm();
  return sum;
}

}  // namespace

/// What is left of all forces on each node, without those that rigid holds answer.
Structure::Data::Balance Structure::Data::balance() {
  Balance balance{std::vector<Vec3>(x.size()), Vec3::Zero(), 0.0};
  elements.forget_out_of_bounds();
#pragma omp parallel num_threads(elements.threads())
  {
    elements.compute_forces(x);
#pragma omp for schedule(static)
    for (std::size_t node = 0; node < x.size(); ++node) {
      balance.left[node] = nodal_force(static_cast<int>(node));
    }
  }
  double squares = 0.0;
  for (std::size_t node = 0; node < x.size(); ++node) {
    Vec3& left = balance.left[node];
    Vec3 load = own_mass[node] * loads.gravity;
    left += load;
    if (!dead_load.empty()) load += dead_load[node];
    squares += (load + elements.nodal_load(static_cast<int>(node))).squaredNorm();
    for (int axis = 0; axis < 3; ++axis) {
      const Hold* hold = hold_of_node[node][axis];
      if (hold == nullptr) continue;
      const double away = mesh.nodes[node][axis] + displacement_of(*hold, axis) - x[node][axis];
      const double held = hold->rigid ? -left[axis] : elements.nodal_volume()[node] * hold->stiffness * away;
      left[axis] += held;
      balance.reaction[axis] += held;
      squares += held * held;
    }
  }
  balance.scale = std::sqrt(squares);
  return balance;
}

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

void Structure::Data::move_rigidly_held() {
  for (std::size_t node = 0; node < x.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      const Hold* hold = hold_of_node[node][axis];
      if (hold && hold->rigid) x[node][axis] = mesh.nodes[node][axis] + displacement_of(*hold, axis);
    }
  }
}

int Structure::relax(double time, const RelaxationOptions& options) {
  Data& d = *data_;
  d.set_time(time);
  d.move_rigidly_held();
  std::ranges::fill(d.v, Vec3::Zero());
  const std::vector<double> least_stiffness = d.elements.nodal_stiffness(d.mesh.nodes);
  std::vector<double> mass;
  std::vector<Vec3> last_change(d.x.size(), Vec3::Zero());
  double energy_before = 0.0, scale = 0.0, residual = INFINITY;
  for (int iteration = 0; iteration < options.most_iterations; ++iteration) {
    if (iteration % refresh_interval == 0) mass = d.fictitious_masses(least_stiffness);
    const Data::Balance balance = d.balance();
    if (d.elements.out_of_bounds()) d.report_divergence(time);
    const double left = std::sqrt(squared_norm(balance.left));
    scale = std::max(balance.scale, iteration == 0 ? left : scale);
    residual = scale > 0.0 ? left / scale : 0.0;
    if (residual <= options.tolerance) {
      std::ranges::fill(d.v, Vec3::Zero());
      d.reaction = balance.reaction;
      d.estimate_largest_frequency();
      return iteration;
    }
    double energy = 0.0;
    for (std::size_t node = 0; node < d.x.size(); ++node) {
      d.v[node] += balance.left[node] / mass[node];
      energy += 0.5 * mass[node] * d.v[node].squaredNorm();
    }
    const bool past_peak = energy < energy_before;
    energy_before = past_peak ? 0.0 : energy;
    for (std::size_t node = 0; node < d.x.size(); ++node) {
      // The peak lies, by linear interpolation of the energy, about half a step back.
      if (past_peak) {
        d.x[node] -= 0.5 * last_change[node];
        d.v[node].setZero();
      } else {
        last_change[node] = d.v[node];
        d.x[node] += d.v[node];
      }
    }
  }
  throw Diverged(
      fmt::format("no equilibrium of the structure was found at t = {:.6g} s in {} iterations: forces of "
                  "{:.3g} of the loads and reactions are left, expected {:g}; a mechanism, or motion that "
                  "nothing holds",
                  time, options.most_iterations, residual, options.tolerance));
}

}  // namespace drogue::fem
