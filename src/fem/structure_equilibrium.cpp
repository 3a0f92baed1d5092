// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium of a Structure: what balances, by which method it is found, and what is said if it is not.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "fem/structure_data.hpp"

namespace drogue::fem {

std::vector<Vec3> Structure::Data::way_of_held(std::span<const Vec3> from) const {
  std::vector<Vec3> way(from.size(), Vec3::Zero());
  for (std::size_t node = 0; node < from.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!is_rigid(static_cast<int>(node), axis)) continue;
      way[node][axis] = mesh.nodes[node][axis] + displacement_of(*hold_of_node[node][axis], axis) - from[node][axis];
    }
  }
  return way;
}

Balance Structure::Data::balance(std::span<const Vec3> at, std::span<const Vec3> body_force) {
  Balance balance{std::vector<Vec3>(at.size()), Vec3::Zero(), 0.0, true};
  elements.forget_out_of_bounds();
#pragma omp parallel num_threads(elements.threads())
  {
    elements.compute_forces(at);
#pragma omp for schedule(static)
    for (std::size_t node = 0; node < at.size(); ++node) {
      balance.left[node] = nodal_force(static_cast<int>(node));
    }
  }
  balance.inside = !elements.out_of_bounds();
  double squares = 0.0;
  for (std::size_t node = 0; node < at.size(); ++node) {
    Vec3& left = balance.left[node];
    Vec3 load = body_force[node];
    left += load;
    if (!dead_load.empty()) load += dead_load[node];
    squares += (load + elements.nodal_load(static_cast<int>(node))).squaredNorm();
    for (int axis = 0; axis < 3; ++axis) {
      const Hold* hold = hold_of_node[node][axis];
      if (hold == nullptr) continue;
      const double away = mesh.nodes[node][axis] + displacement_of(*hold, axis) - at[node][axis];
      const double held = hold->rigid ? -left[axis] : elements.nodal_volume()[node] * hold->stiffness * away;
      left[axis] += held;
      balance.reaction[axis] += held;
      squares += held * held;
    }
  }
  balance.scale = std::sqrt(squares);
  return balance;
}

std::vector<Vec3> Structure::Data::own_weight() const {
  std::vector<Vec3> force;
  for (const double m : own_mass) force.emplace_back(load_share * m * loads.gravity);
  return force;
}

NodalMatrix Structure::Data::tethers() const {
  NodalMatrix stiffness{std::vector<Vec3>(x.size(), Vec3::Zero()), {}};
  for (std::size_t node = 0; node < x.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      const Hold* hold = hold_of_node[node][axis];
      if (hold && !hold->rigid) stiffness.diagonal[node][axis] = elements.nodal_volume()[node] * hold->stiffness;
    }
  }
  return stiffness;
}

Newton& Structure::Data::newton() {
  if (!solver) {
    SparseSystem::Held held(x.size());
    for (std::size_t node = 0; node < x.size(); ++node) {
      for (int axis = 0; axis < 3; ++axis) held[node][axis] = is_rigid(static_cast<int>(node), axis);
    }
    solver = std::make_unique<Newton>(elements, held, mass_matrix.pairs, elements.nodal_stiffness(mesh.nodes));
  }
  return *solver;
}

/// The loads are applied at once, or in parts if that fails.
int Structure::Data::balance_by_newton(double time, const EquilibriumOptions& asked) {
  constexpr double least_part = 1.0 / 256.0;
  const NodalMatrix added = tethers();
  const auto forces = [this](std::span<const Vec3> at) { return balance(at, own_weight()); };
  int iterations = 0;
  double applied = 0.0, part = 1.0;
  while (applied < 1.0) {
    const double share = std::min(1.0, applied + part);
    set_time(time, share);
    std::vector<Vec3> trial = x;
    const NewtonOutcome outcome = newton().solve(trial, way_of_held(x), forces, added, asked.tolerance);
    iterations += outcome.iterations;
    if (outcome.balanced) {
      x = std::move(trial);
      applied = share;
      continue;
    }
    part *= 0.5;
    if (part < least_part) report_imbalance(time, outcome.residual, asked.tolerance);
  }
  reaction = forces(x).reaction;
  return iterations;
}

void Structure::Data::report_imbalance(double time, double residual, double tolerance) const {
  throw Diverged(
      fmt::format("no equilibrium of the structure was found at t = {:.6g} s: forces of "
                  "{:.3g} of the loads and reactions are left, expected {:g}; a mechanism, or motion that "
                  "nothing holds",
                  time, residual, tolerance));
}

Integrator Structure::integrator_for(double) const { return data_->options.integrator; }

int Structure::find_equilibrium(double time, const EquilibriumOptions& options) {
  Data& d = *data_;
  d.set_time(time);
  std::ranges::fill(d.v, Vec3::Zero());
  const int iterations =
      options.method == Equilibrium::relaxation ? d.relax(time, options) : d.balance_by_newton(time, options);
  std::ranges::fill(d.v, Vec3::Zero());
  d.acceleration.clear();
  d.estimate_largest_frequency();
  return iterations;
}

}  // namespace drogue::fem
