// SPDX-License-Identifier: GPL-3.0-or-later
// Implicit motion of a Structure: generalised-alpha (Chung & Hulbert, J. Appl. Mech. 60 (1993) 371),
//   M a_{n+1-am} + C v_{n+1-af} = f(x_{n+1-af}, t_{n+1-af}),   z_{n+1-a} = (1 - a) z_{n+1} + a z_n,
//   x_{n+1} = x_n + dt v_n + dt^2 ((1/2 - beta) a_n + beta a_{n+1}),   v_{n+1} = v_n + dt ((1 - gamma) a_n + gamma
//   a_{n+1}),
// of second order, with M that of the points (structure_data.hpp). Of a mode that the step does not resolve the share
// `spectral_radius` is left after each; none is damped with 1. Unstable steps there are none, inaccurate ones there
// are: what is faster than a few steps is not resolved. The unknown is x_{n+1-af}, in which inertia and dampers are
// springs.
#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "fem/structure_data.hpp"

namespace drogue::fem {
namespace {

constexpr double tolerance = 1e-8;  // of the balance of forces
constexpr int most_parts = 256;     // of a step whose balance is not found

struct GeneralisedAlpha {
  double alpha_m, alpha_f, beta, gamma;

  explicit GeneralisedAlpha(double radius)
      : alpha_m((2.0 * radius - 1.0) / (radius + 1.0)),
        alpha_f(radius / (radius + 1.0)),
        beta(0.25 * std::pow(1.0 - alpha_m + alpha_f, 2)),
        gamma(0.5 - alpha_m + alpha_f) {}
};

std::vector<Vec3> combined(double s, std::span<const Vec3> a, double t, std::span<const Vec3> b) {
  std::vector<Vec3> sum(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) sum[i] = s * a[i] + t * b[i];
  return sum;
}

void add(NodalMatrix& sum, double factor, const NodalMatrix& matrix) {
  for (std::size_t node = 0; node < sum.diagonal.size(); ++node) sum.diagonal[node] += factor * matrix.diagonal[node];
  for (const auto& [a, b, value] : matrix.pairs) sum.pairs.push_back({a, b, factor * value});
}

}  // namespace

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

/// Adds the impulse of the holds; leaves everything as it was if no balance is found.
NewtonOutcome Structure::Data::step_implicitly(double dt, double time, Vec3& impulse) {
  const GeneralisedAlpha scheme(options.spectral_radius);
  const double now = 1.0 - scheme.alpha_f;  // the share of the new state in that which is balanced
  set_time(time + dt);
  const std::vector<Vec3> way = way_of_held(x);
  set_time(time + now * dt);

  // What x_{n+1} - x_n says of the other fields.
  const double per_square = 1.0 / (scheme.beta * dt * dt);
  const auto new_acceleration = [&](std::span<const Vec3> moved) {
    std::vector<Vec3> a = combined(per_square, moved, -per_square * dt, v);
    return combined(1.0, a, 1.0 - 0.5 / scheme.beta, acceleration);
  };
  const auto new_velocity = [&](std::span<const Vec3> a) {
    return combined(1.0, v, dt, combined(1.0 - scheme.gamma, acceleration, scheme.gamma, a));
  };
  const auto put_held = [&](std::vector<Vec3>& a, std::vector<Vec3>& velocity) {
    for (std::size_t node = 0; node < x.size(); ++node) {
      for (int axis = 0; axis < 3; ++axis) {
        if (!is_rigid(static_cast<int>(node), axis)) continue;
        velocity[node][axis] = way[node][axis] / dt;
        a[node][axis] = (velocity[node][axis] - v[node][axis]) / dt;
      }
    }
  };
  struct State {
    std::vector<Vec3> moved, velocity, acceleration;
  };
  const auto state_of = [&](std::span<const Vec3> at) {
    State state;
    state.moved = combined(1.0 / now, at, -1.0 / now, x);
    state.acceleration = new_acceleration(state.moved);
    state.velocity = new_velocity(state.acceleration);
    put_held(state.acceleration, state.velocity);
    return state;
  };

  const NodalMatrix damping = dampers();
  const auto forces = [&](std::span<const Vec3> at) {
    const State state = state_of(at);
    const auto inertial =
        mass_matrix.times(combined(1.0 - scheme.alpha_m, state.acceleration, scheme.alpha_m, acceleration));
    const auto drag = damping.times(combined(now, state.velocity, scheme.alpha_f, v));
    return balance(at, combined(1.0, combined(1.0, nodal_weight, -1.0, inertial), -1.0, drag));
  };
  NodalMatrix added = tethers();
  add(added, (1.0 - scheme.alpha_m) * per_square / now, mass_matrix);
  add(added, scheme.gamma / (scheme.beta * dt), damping);

  std::vector<Vec3> at = combined(1.0, x, now * dt, v);
  std::vector<Vec3> prescribed = combined(now, way, 0.0, way);
  for (std::size_t node = 0; node < x.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      if (is_rigid(static_cast<int>(node), axis)) at[node][axis] = x[node][axis];
    }
  }
  if (!forces(at).inside) at = x;
  const NewtonOutcome outcome = newton().solve(at, prescribed, forces, added, tolerance);
  if (!outcome.balanced) return outcome;
  impulse += dt * forces(at).reaction;
  State state = state_of(at);
  x = combined(1.0, x, 1.0, state.moved);
  v = std::move(state.velocity);
  acceleration = std::move(state.acceleration);
  return outcome;
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
    const NewtonOutcome outcome = step_implicitly(part, begin, impulse);
    if (outcome.balanced) {
      ++done;
    } else if (substeps < most_parts) {
      substeps *= 2;
      done *= 2;
    } else if (elements.out_of_bounds()) {
      report_divergence(begin);
    } else {
      throw Diverged(
          fmt::format("the forces of the structure do not balance at t = {:.6g} s in steps of {:.3g} s", begin, part));
    }
  }
  hold_impulse.front() += impulse;
  estimate_largest_frequency();
}

}  // namespace drogue::fem
