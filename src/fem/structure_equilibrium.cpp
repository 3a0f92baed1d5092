// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium of a Structure: what balances, Newton's method for it, and what is said if there is none.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/error.hpp"
#include "fem/structure_data.hpp"

namespace drogue::fem {
namespace {

/// The first node of the part of the body that each node belongs to.
std::vector<int> parts_of(const Elements& elements, std::size_t nodes) {
  std::vector<int> first(nodes);
  std::iota(first.begin(), first.end(), 0);
  const auto root = [&](int node) {
    while (first[node] != node) node = first[node] = first[first[node]];
    return node;
  };
  for (const auto& group : elements.groups()) {
    for (int e = 0; e < group->count(); ++e) {
      for (const int node : group->nodes_of(e)) {
        const int a = root(node), b = root(group->nodes_of(e)[0]);
        first[std::max(a, b)] = std::min(a, b);
      }
    }
  }
  for (std::size_t node = 0; node < nodes; ++node) first[node] = root(static_cast<int>(node));
  return first;
}

}  // namespace

std::vector<Vec3> Structure::Data::way_of_held(std::span<const Vec3> from) const {
  std::vector<Vec3> way(from.size(), Vec3::Zero());
  for_each_rigid([&](std::size_t node, int axis) {
    way[node][axis] = mesh.nodes[node][axis] + displacement_of(*hold_of_node[node][axis], axis) - from[node][axis];
  });
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
    for_each_rigid([&](std::size_t node, int axis) { held[node][axis] = true; });
    solver = std::make_unique<Newton>(elements, held, mass_matrix.pairs, elements.nodal_stiffness(mesh.nodes));
  }
  return *solver;
}

/// The loads are applied at once, or, if that fails, in parts.
int Structure::Data::balance_by_newton(double time, const EquilibriumOptions& asked) {
  constexpr double least_part = 1.0 / 16.0;
  const NodalMatrix added = tethers();
  const auto forces = [this](std::span<const Vec3> at) { return balance(at, own_weight()); };
  int iterations = 0;
  double applied = 0.0, part = 1.0;
  while (applied < 1.0) {
    const double share = std::min(1.0, applied + part);
    set_time(time, share);
    std::vector<Vec3> trial = x;
    const Newton::Outcome outcome = newton().solve(trial, way_of_held(x), forces, added, asked.tolerance);
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
  if (const auto motion = newton().find_free_motion(x, added)) {
    free_motion = describe(*motion);
  }
  return iterations;
}

std::string Structure::Data::describe(int node) const {
  const Vec3& p = mesh.nodes[node];
  return fmt::format("node {} at ({:g}, {:g}, {:g}) m", node, p.x(), p.y(), p.z());
}

std::string Structure::Data::describe(const Newton::FreeMotion& motion) const {
  return fmt::format("nothing resists a motion of {} along ({:.2g}, {:.2g}, {:.2g})", describe(motion.node),
                     motion.direction.x(), motion.direction.y(), motion.direction.z());
}

/// No equilibrium exists if loads push a part along an axis on which none of its nodes is held.
void Structure::Data::expect_unheld_parts_unloaded() {
  const std::vector<int> part = parts_of(elements, x.size());
  const Balance now = balance(x, own_weight());
  std::vector<Vec3> load(x.size(), Vec3::Zero());
  std::vector<std::array<bool, 3>> is_held(x.size(), {false, false, false});
  for (std::size_t node = 0; node < x.size(); ++node) {
    load[part[node]] += now.left[node];
    for (int axis = 0; axis < 3; ++axis) is_held[part[node]][axis] |= hold_of_node[node][axis] != nullptr;
  }
  for (std::size_t node = 0; node < x.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      if (is_held[node][axis] || std::abs(load[node][axis]) <= 1e-6 * norm(now.left)) continue;
      throw InputError(
          fmt::format("nothing holds the part of the structure with {} along {}, and loads of {:.4g} N push it that "
                      "way; expected a hold",
                      describe(static_cast<int>(node)), "xyz"[axis], load[node][axis]));
    }
  }
}

void Structure::Data::report_imbalance(double time, double residual, double tolerance) {
  std::string cause = "; a mechanism, or motion that nothing holds";
  if (const auto motion = newton().find_free_motion(x, tethers())) {
    cause = "; " + describe(*motion);
  }
  throw Diverged(
      fmt::format("no equilibrium of the structure was found at t = {:.6g} s: forces of {:.3g} of the loads and "
                  "reactions are left, expected {:g}{}",
                  time, residual, tolerance, cause));
}

int Structure::find_equilibrium(double time, const EquilibriumOptions& options) {
  Data& d = *data_;
  d.set_time(time);
  d.acceleration.clear();
  d.free_motion.clear();
  d.expect_unheld_parts_unloaded();
  const Equilibrium method = options.method == Equilibrium::cheaper ? cheaper_equilibrium() : options.method;
  std::ranges::fill(d.v, Vec3::Zero());
  d.substeps = method == Equilibrium::relaxation ? d.relax(time, options) : d.balance_by_newton(time, options);
  std::ranges::fill(d.v, Vec3::Zero());
  d.estimate_largest_frequency();
  return d.substeps;
}

const std::string& Structure::free_motion() const { return data_->free_motion; }

}  // namespace drogue::fem
