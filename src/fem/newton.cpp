// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/newton.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace drogue::fem {
namespace {

constexpr int most_iterations = 500;
constexpr double least_mu = 1e-8, most_mu = 1e4;

double dot(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

std::vector<Vec3> moved(std::span<const Vec3> x, double share, std::span<const Vec3> u) {
  std::vector<Vec3> y(x.begin(), x.end());
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += share * u[i];
  return y;
}

struct Step {
  double share;
  std::vector<Vec3> x;
  Balance balance;
};

/// Along `u` as far as the work of the forces stays, or comes back, above minus half of what it is at the beginning.
Step search(std::span<const Vec3> x, std::span<const Vec3> u, double work, const Newton::Forces& forces) {
  constexpr int most_trials = 30;
  double low = 0.0, low_work = work, high = 0.0;
  Step trial{1.0, {}, {}};
  for (int trials = 0; trials < most_trials; ++trials) {
    trial.x = moved(x, trial.share, u);
    trial.balance = forces(trial.x);
    const double now = trial.balance.inside ? dot(trial.balance.left, u) : -INFINITY;
    if (std::abs(now) <= 0.5 * work || (now > 0.0 && high == 0.0)) return trial;
    if (now > 0.0) {
      low = trial.share;
      low_work = now;
    } else {
      high = trial.share;
    }
    const double secant = std::isfinite(now) && now < 0.0 ? low_work / (low_work - now) : 0.5;
    trial.share = low + std::clamp(secant, 0.1, 0.5) * (high - low);
  }
  return trial;
}

}  // namespace

double norm(std::span<const Vec3> field) { return std::sqrt(dot(field, field)); }

Newton::Newton(Elements& elements, const SparseSystem::Held& held, std::span<const NodalMatrix::Pair> pairs,
               std::vector<double> damping)
    : elements_(elements), stiffness_(elements), system_(stiffness_, held, pairs), damping_(std::move(damping)) {}

/// Solves for the step with as much damping as it takes; nothing if no amount suffices.
std::vector<Vec3> Newton::step(std::span<const Vec3> x, const std::vector<Vec3>& left, const NodalMatrix& added) {
  stiffness_.update(x);
  for (; mu_ < most_mu; mu_ = std::max(least_mu, 10.0 * mu_)) {
    NodalMatrix sum = added;
    for (std::size_t node = 0; node < damping_.size(); ++node) sum.diagonal[node].array() += mu_ * damping_[node];
    if (!system_.factorise(sum)) continue;
    std::vector<Vec3> u = system_.solve(left);
    if (dot(left, u) >= 0.0) return u;
  }
  return {};
}

/// What the last bit of the positions does to the forces [N].
double Newton::rounding_of_forces(std::span<const Vec3> x, const NodalMatrix& added) const {
  std::vector<Vec3> stiff = added.times(x);
  for (std::size_t node = 0; node < x.size(); ++node) stiff[node] += damping_[node] * x[node];
  return 4.0 * std::numeric_limits<double>::epsilon() * norm(stiff);
}

NewtonOutcome Newton::solve(std::vector<Vec3>& x, const std::vector<Vec3>& prescribed, const Forces& forces,
                            const NodalMatrix& added, double tolerance) {
  NewtonOutcome outcome{false, 0, INFINITY};
  Balance balance = forces(x);
  if (!balance.inside) return outcome;
  double scale = norm(balance.left);
  const double rounding = rounding_of_forces(x, added);
  bool move_held = norm(prescribed) > 0.0;
  mu_ = 0.0;
  for (; outcome.iterations < most_iterations; ++outcome.iterations) {
    scale = std::max(scale, balance.scale);
    outcome.residual = scale > 0.0 ? norm(balance.left) / scale : 0.0;
    if (std::getenv("NEWTON_DEBUG"))
      std::printf("  %d residual %.3e mu %.2e\n", outcome.iterations, outcome.residual, mu_);
    outcome.balanced = !move_held && (outcome.residual <= tolerance || norm(balance.left) <= rounding);
    if (outcome.balanced) return outcome;
    std::vector<Vec3> u;
    if (move_held) {
      stiffness_.update(x);
      const std::vector<Vec3> pulled = stiffness_.times(prescribed);
      u = step(x, moved(balance.left, -1.0, pulled), added);
      if (u.empty()) return outcome;
      x = moved(moved(x, 1.0, u), 1.0, prescribed);
      balance = forces(x);
      if (!balance.inside) return outcome;
      scale = std::max(scale, norm(balance.left));
      move_held = false;
      continue;
    }
    u = step(x, balance.left, added);
    if (u.empty()) return outcome;
    Step taken = search(x, u, dot(balance.left, u), forces);
    if (std::getenv("NEWTON_DEBUG")) std::printf("     share %.4f\n", taken.share);
    if (!taken.balance.inside) return outcome;
    if (taken.share == 1.0) {
      if (norm(taken.balance.left) < norm(balance.left)) mu_ *= 0.1;
      if (mu_ < least_mu) mu_ = 0.0;
    } else if (taken.share < 0.25) {
      mu_ = std::max(least_mu, std::min(10.0, 1.0 / taken.share) * mu_);
    }
    x = std::move(taken.x);
    balance = std::move(taken.balance);
  }
  return outcome;
}

}  // namespace drogue::fem
