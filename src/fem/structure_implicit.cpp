// SPDX-License-Identifier: GPL-3.0-or-later
// Implicit motion of a Structure: generalised-alpha (Chung & Hulbert, J. Appl. Mech. 60 (1993) 371),
//   M a_{n+1-am} + C v_{n+1-af} = f(x_{n+1-af}, t_{n+1-af}),   z_{n+1-a} = (1 - a) z_{n+1} + a z_n,
//   x_{n+1} = x_n + dt v_n + dt^2 ((1/2 - beta) a_n + beta a_{n+1}),
//   v_{n+1} = v_n + dt ((1 - gamma) a_n + gamma a_{n+1}),
// of second order and stable for any step, with the masses M of the points (structure_data.hpp). Of a mode that is much
// faster than the step a share `spectral_radius` is left after each; with 1 none is damped. The unknown is
// x_{n+1-af}, which inertia and dampers pull like springs.
#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "fem/structure_data.hpp"

namespace drogue::fem {
namespace {

constexpr double tolerance = 1e-8;  // of the balance of forces
constexpr int most_parts = 256;     // of a step whose balance is not found

void add(NodalMatrix& sum, double factor, const NodalMatrix& matrix) {
  for (std::size_t node = 0; node < sum.diagonal.size(); ++node) sum.diagonal[node] += factor * matrix.diagonal[node];
  for (const auto& [a, b, value] : matrix.pairs) sum.pairs.push_back({a, b, factor * value});
}

}  // namespace

/// From x_n, v_n, a_n of the structure over `dt`: what follows from the position `at` of the balance.
struct Structure::Data::ImplicitStep {
  Data& d;
  double dt;
  std::vector<Vec3> way;  ///< x_{n+1} - x_n of what is held rigidly
  double alpha_m, alpha_f, beta, gamma;
  NodalMatrix damping;

  ImplicitStep(Data& data, double time, double step) : d(data), dt(step), damping(data.dampers()) {
    const double radius = d.options.spectral_radius;
    alpha_m = (2.0 * radius - 1.0) / (radius + 1.0);
    alpha_f = radius / (radius + 1.0);
    beta = 0.25 * std::pow(1.0 - alpha_m + alpha_f, 2);
    gamma = 0.5 - alpha_m + alpha_f;
    d.set_time(time + dt);
    way = d.way_of_held(d.x);
    d.set_time(time + (1.0 - alpha_f) * dt);
  }

  struct State {
    std::vector<Vec3> way, v, a;  ///< x_{n+1} - x_n, v_{n+1}, a_{n+1}
  };
  State state(std::span<const Vec3> at) const {
    State s{combined(1.0, at, -1.0, d.x), {}, {}};
    for (Vec3& u : s.way) u /= 1.0 - alpha_f;
    const double per_square = 1.0 / (beta * dt * dt);
    s.a = combined(1.0, combined(per_square, s.way, -per_square * dt, d.v), 1.0 - 0.5 / beta, d.acceleration);
    s.v = combined(1.0, d.v, dt, combined(1.0 - gamma, d.acceleration, gamma, s.a));
    d.for_each_rigid([&](std::size_t node, int axis) {
      s.v[node][axis] = way[node][axis] / dt;
      s.a[node][axis] = (s.v[node][axis] - d.v[node][axis]) / dt;
    });
    return s;
  }

  /// With inertia and dampers as forces.
  Balance balance(std::span<const Vec3> at) const {
    const State s = state(at);
    const auto inertial = d.mass_matrix.times(combined(1.0 - alpha_m, s.a, alpha_m, d.acceleration));
    const auto drag = damping.times(combined(1.0 - alpha_f, s.v, alpha_f, d.v));
    return d.balance(at, combined(1.0, d.nodal_weight, -1.0, combined(1.0, inertial, 1.0, drag)));
  }

  /// Minus the derivative of the balance, but for the elements.
  NodalMatrix springs() const {
    NodalMatrix sum = d.tethers();
    add(sum, (1.0 - alpha_m) / ((1.0 - alpha_f) * beta * dt * dt), d.mass_matrix);
    add(sum, gamma / (beta * dt), damping);
    return sum;
  }

  /// With the velocity it has, or where it is if that would tear an element.
  std::vector<Vec3> first_guess() const {
    std::vector<Vec3> guess = combined(1.0, d.x, (1.0 - alpha_f) * dt, d.v);
    d.for_each_rigid([&](std::size_t node, int axis) { guess[node][axis] = d.x[node][axis]; });
    return balance(guess).inside ? guess : d.x;
  }
};

/// Damping of the own masses and of tethers [N s/m].
NodalMatrix Structure::Data::dampers() const {
  NodalMatrix damping{std::vector<Vec3>(x.size()), {}};
  for (std::size_t node = 0; node < x.size(); ++node) {
    damping.diagonal[node].setConstant(loads.damping * own_mass[node]);
    for (int axis = 0; axis < 3; ++axis) {
      const Hold* hold = hold_of_node[node][axis];
      if (hold && !hold->rigid) damping.diagonal[node][axis] += elements.nodal_volume()[node] * hold->damping;
    }
  }
  return damping;
}

/// That of the forces as they are; none along what is held rigidly.
void Structure::Data::find_acceleration() {
  const std::vector<Vec3> force = balance(x, combined(1.0, nodal_weight, -1.0, dampers().times(v))).left;
  acceleration.resize(x.size());
  for (const Point& p : points) {
    if (!p.is_pair()) {
      acceleration[p.a] = force[p.a] / p.mean.mass;
      continue;
    }
    const Vec3 mean = (force[p.a] + force[p.b]) / p.mean.mass;
    const Vec3 difference = (p.share_b * force[p.a] - p.share_a * force[p.b]) / p.difference.mass;
    acceleration[p.a] = mean + p.share_b * difference;
    acceleration[p.b] = mean - p.share_a * difference;
  }
}

/// False if no balance is found, and then nothing has changed. Adds the impulse of the holds.
bool Structure::Data::step_implicitly(double dt, double time, Vec3& impulse) {
  const ImplicitStep step(*this, time, dt);
  std::vector<Vec3> at = step.first_guess(), prescribed = step.way;
  for (Vec3& u : prescribed) u *= 1.0 - step.alpha_f;
  const auto forces = [&](std::span<const Vec3> positions) { return step.balance(positions); };
  if (!newton().solve(at, prescribed, forces, step.springs(), tolerance).balanced) return false;
  impulse += dt * step.balance(at).reaction;
  ImplicitStep::State next = step.state(at);
  for (std::size_t node = 0; node < x.size(); ++node) x[node] += next.way[node];
  v = std::move(next.v);
  acceleration = std::move(next.a);
  return true;
}

void Structure::Data::advance_implicitly(double dt, double time) {
  if (acceleration.empty()) {
    set_time(time);
    find_acceleration();
  }
  substeps = 1;
  Vec3 impulse = Vec3::Zero();
  for (int done = 0; done < substeps;) {
    const double part = dt / substeps, begin = time + done * part;
    if (step_implicitly(part, begin, impulse)) {
      ++done;
      continue;
    }
    if (substeps == most_parts) {
      if (elements.out_of_bounds()) report_divergence(begin);
      throw Diverged(fmt::format(
          "the forces of the structure find no balance at t = {:.6g} s, in steps as short as {:.3g} s", begin, part));
    }
    substeps *= 2;
    done *= 2;
  }
  hold_impulse.front() += impulse;
  estimate_largest_frequency();
}

}  // namespace drogue::fem
