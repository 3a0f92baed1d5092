// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace drogue::fem {
namespace {

constexpr int most_iterations = 500;  // slack cables that are a million times stiffer along than across take 150
constexpr double least_mu = 1e-8, most_mu = 1e4;

double dot(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

struct Step {
  double share;
  std::vector<Vec3> x;
  Balance balance;
};

/// Along `u`, on which the forces at first do `work`: in full, or as far as they do at least minus half of it.
Step search(std::span<const Vec3> x, std::span<const Vec3> u, double work, const Newton::Forces& forces) {
  constexpr int most_trials = 30;
  double low = 0.0, low_work = work, high = 0.0;
  Step step{1.0, {}, {}};
  for (int trial = 0; trial < most_trials; ++trial) {
    step.x = combined(1.0, x, step.share, u);
    step.balance = forces(step.x);
    const double now = step.balance.inside ? dot(step.balance.left, u) : -INFINITY;
    const bool too_short = now > 0.5 * work && high > 0.0;
    if (now >= -0.5 * work && !too_short) return step;
    if (too_short) {
      low = step.share;
      low_work = now;
    } else {
      high = step.share;
    }
    const double secant = now < 0.0 ? low_work / (low_work - now) : 0.5;
    step.share = low + std::clamp(secant, 0.1, 0.5) * (high - low);
  }
  return step;
}

}  // namespace

double norm(std::span<const Vec3> field) { return std::sqrt(dot(field, field)); }

std::vector<Vec3> combined(double s, std::span<const Vec3> a, double t, std::span<const Vec3> b) {
  std::vector<Vec3> sum(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) sum[i] = s * a[i] + t * b[i];
  return sum;
}

Newton::Newton(Elements& elements, const SparseSystem::Held& held, std::span<const NodalMatrix::Pair> pairs,
               std::vector<double> damping)
    : elements_(elements), stiffness_(elements), system_(stiffness_, held, pairs), damping_(std::move(damping)) {}

Newton::Outcome Newton::solve(std::vector<Vec3>& x, const std::vector<Vec3>& prescribed, const Forces& forces,
                              const NodalMatrix& added, double tolerance) {
  Outcome outcome{false, 0, INFINITY};
  Balance balance = forces(x);
  if (!balance.inside) return outcome;
  const double rounding = rounding_of_forces(x, added);
  double scale = norm(balance.left);
  bool in_place = norm(prescribed) == 0.0;
  mu_ = 0.0;
  for (; outcome.iterations < most_iterations; ++outcome.iterations) {
    const double left = norm(balance.left);
    scale = std::max(scale, balance.scale);
    outcome.residual = left > rounding ? left / scale : 0.0;
    outcome.balanced = in_place && outcome.residual <= tolerance;
    if (outcome.balanced) return outcome;
    const bool goes_on =
        in_place ? improve(x, balance, forces, added) : move_held(x, prescribed, balance, forces, added);
    if (!goes_on) return outcome;
    if (!in_place) scale = std::max(scale, norm(balance.left));
    in_place = true;
  }
  return outcome;
}

/// What the last bit of the positions does to the forces [N].
double Newton::rounding_of_forces(std::span<const Vec3> x, const NodalMatrix& added) const {
  std::vector<Vec3> stiff = added.times(x);
  for (std::size_t node = 0; node < x.size(); ++node) stiff[node] += damping_[node] * x[node];
  return 4.0 * std::numeric_limits<double>::epsilon() * norm(stiff);
}

/// With all else following as the tangent says; false if that fails.
bool Newton::move_held(std::vector<Vec3>& x, const std::vector<Vec3>& prescribed, Balance& balance,
                       const Forces& forces, const NodalMatrix& added) {
  stiffness_.update(x);
  const std::vector<Vec3> pulled = combined(1.0, balance.left, -1.0, stiffness_.times(prescribed));
  const std::vector<Vec3> u = step_against(pulled, added);
  if (u.empty()) return false;
  x = combined(1.0, combined(1.0, x, 1.0, u), 1.0, prescribed);
  balance = forces(x);
  return balance.inside;
}

/// One iteration; false if there is no way on.
bool Newton::improve(std::vector<Vec3>& x, Balance& balance, const Forces& forces, const NodalMatrix& added) {
  stiffness_.update(x);
  const std::vector<Vec3> u = step_against(balance.left, added);
  if (u.empty()) return false;
  Step step = search(x, u, dot(balance.left, u), forces);
  if (!step.balance.inside) return false;
  if (step.share < 0.25) {
    mu_ = std::max(least_mu, std::min(10.0, 1.0 / step.share) * mu_);
  } else if (step.share == 1.0 && norm(step.balance.left) < norm(balance.left)) {
    mu_ = mu_ > 10.0 * least_mu ? 0.1 * mu_ : 0.0;
  }
  x = std::move(step.x);
  balance = std::move(step.balance);
  return true;
}

/// With as much damping as it takes for the force to do work on it; nothing if no amount suffices.
std::vector<Vec3> Newton::step_against(const std::vector<Vec3>& force, const NodalMatrix& added) {
  for (; mu_ < most_mu; mu_ = std::max(least_mu, 10.0 * mu_)) {
    if (!factorise(added)) continue;
    std::vector<Vec3> u = system_.solve(force);
    if (dot(force, u) >= 0.0) return u;
  }
  return {};
}

bool Newton::factorise(const NodalMatrix& added) {
  NodalMatrix sum = added;
  for (std::size_t node = 0; node < damping_.size(); ++node) sum.diagonal[node].array() += mu_ * damping_[node];
  return system_.factorise(sum);
}

std::optional<Newton::FreeMotion> Newton::find_free_motion(std::span<const Vec3> x, const NodalMatrix& added) {
  constexpr double hardly = 1e-12;  // of the stiffness D
  stiffness_.update(x);
  mu_ = least_mu;
  if (!factorise(added)) return std::nullopt;          // not a stable state: something else is wrong with it
  std::vector<Vec3> u(x.size(), Vec3(1.0, 0.7, 0.4));  // not across any motion that is likely
  double resistance = 1.0;
  for (int iteration = 0; iteration < 8; ++iteration) {
    for (std::size_t node = 0; node < x.size(); ++node) u[node] *= damping_[node];
    u = system_.solve(u);
    const double size = norm(u);
    if (size == 0.0) return std::nullopt;
    for (Vec3& v : u) v /= size;
    std::vector<Vec3> scaled = u;
    for (std::size_t node = 0; node < x.size(); ++node) scaled[node] *= damping_[node];
    resistance = dot(u, combined(1.0, stiffness_.times(u), 1.0, added.times(u))) / dot(u, scaled);
  }
  if (std::abs(resistance) > hardly) return std::nullopt;
  const auto most = std::ranges::max_element(u, {}, [](const Vec3& v) { return v.squaredNorm(); });
  return FreeMotion{static_cast<int>(most - u.begin()), most->normalized()};
}

}  // namespace drogue::fem
