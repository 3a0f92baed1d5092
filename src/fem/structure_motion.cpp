// SPDX-License-Identifier: GPL-3.0-or-later
// Motion of the points of a Structure: for a single node M dv/dt = f; for a pair
//   M d(v_m)/dt = f_a + f_b,   mu d(v_d)/dt = s_b f_a - s_a f_b,   mu = m_a m_b / (m_a + m_b),
// which with M = m_a + m_b is the motion of two free nodes, and a mechanical system with any other M.
//
// Explicit scheme of Tchamwa and Wielgosz (Maheo, Grolleau & Rio, C. R. Mecanique 337, 2009,
// doi:10.1016/j.crme.2009.10.005) with phi = 1 + dissipation:
//   v_{n+1} = v_n + dt a_n,   x_{n+1} = x_n + dt v_n + phi dt^2 a_n.
// Stable for omega dt <= 2 / sqrt(2 phi - 1). A sub-step multiplies the squared modulus of a mode by
// 1 - (phi - 1) (omega dt)^2, so only what it barely resolves is damped. First order; with phi = 1 the leapfrog scheme,
// v standing half a sub-step behind x, and then it conserves linear and angular momentum to round-off. Tethers enter at
// the end of the sub-step, which stays diagonal, so that a stiff one does not shorten it.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/error.hpp"
#include "fem/structure_data.hpp"

namespace drogue::fem {
namespace {

/// Far beyond any useful count: an element that asks for more is crushed or inverted, be it between its Gauss points.
constexpr double most_substeps = 20'000;

/// Sub-steps after which a mode of `phase` = omega dt is no larger than before although its velocity is then multiplied
/// by `r`, wherever in its swing that meets it (docs/theory.md, Coupling).
double substeps_between_resets(double r, double phase, double phi) {
  const double lag = std::pow(0.5 * phi * phase, 2);  // v stands phi / 2 sub-steps behind x
  if (lag >= 1.0) return INFINITY;
  const double c = (1.0 - r) / std::sqrt(1.0 - lag);
  const double growth = 0.5 * (c + std::sqrt(c * c + 4.0 * r));
  return -2.0 * std::log(growth) / std::log1p(-(phi - 1.0) * phase * phase);
}

/// The same for modes much slower than the sub-step.
double substeps_between_resets_of_slow_modes(double r, double phi) {
  return phi * phi * (1.0 - r) / (4.0 * (phi - 1.0) * (1.0 + r));
}

/// Change of the velocity `v` of a coordinate under the force `f`, a damper and a spring `away` from its rest.
double damped_change(double kick, double f, double damping, double stiffness, double away, double v, double dt) {
  return (v + kick * (f + stiffness * away)) / (1.0 + kick * (damping + dt * stiffness)) - v;
}

}  // namespace

/// Change of velocity over `dt` where a hold or damping resists. `follows`: whether the coordinate moves with its hold.
Vec3 Structure::Data::resisted_change(const Point& p, const Inertance& inertance, const Vec3& f, bool follows,
                                      const Coordinate& at, double dt) const {
  const double kick = dt / inertance.mass, damping = loads.damping * inertance.own;
  Vec3 dv;
  for (int axis = 0; axis < 3; ++axis) {
    const Hold* hold = follows || !p.may_turn(axis) ? p.hold[axis] : nullptr;
    const double target = at.reference[axis] + (hold && follows ? displacement_of(*hold, axis) : 0.0);
    if (hold == nullptr) {
      dv[axis] = damped_change(kick, f[axis], damping, 0.0, 0.0, at.velocity[axis], dt);
    } else if (!hold->rigid) {
      dv[axis] = damped_change(kick, f[axis], damping + hold->damping * inertance.volume,
                               hold->stiffness * inertance.volume, target - at.position[axis], at.velocity[axis], dt);
    } else if (hold_moves[hold - loads.holds.data()] && follows) {  // to the target, by what move_node() does
      dv[axis] = ((target - at.position[axis]) / dt - at.velocity[axis]) / (1.0 + options.dissipation);
    } else {
      dv[axis] = 0.0;
    }
  }
  return dv;
}

/// With a `push` [N] besides its other forces.
void Structure::Data::move(std::size_t i, const Vec3& push, double dt) {
  const Point& p = points[i];
  const bool is_free = !p.is_held() && loads.damping == 0.0;
  // `of` takes the coordinate out of a nodal field.
  const auto velocity_change = [&](const Inertance& inertance, const Vec3& f, bool follows, const auto& of) -> Vec3 {
    if (is_free) return (dt / inertance.mass) * f;
    return resisted_change(p, inertance, f, follows, {of(x), of(mesh.nodes), of(v)}, dt);
  };
  const auto move_node = [&](int node, const Vec3& dv) {
    x[node] += dt * (v[node] + (1.0 + options.dissipation) * dv);
    v[node] += dv;
  };
  const auto mean_of = [&p](const std::vector<Vec3>& field) { return p.mean_of(field); };
  const Vec3 load = p.weight + push;
  Vec3 force = nodal_force(p.a), dv;
  if (p.is_pair()) {
    const Vec3 force_b = nodal_force(p.b);
    const Vec3 dv_difference = velocity_change(p.difference, p.share_b * force - p.share_a * force_b, false,
                                               [&p](const auto& field) -> Vec3 { return field[p.a] - field[p.b]; });
    force += force_b;
    force += load;
    dv = velocity_change(p.mean, force, true, mean_of);
    move_node(p.a, dv + p.share_b * dv_difference);
    move_node(p.b, dv - p.share_a * dv_difference);
  } else {
    force += load;
    dv = velocity_change(p.mean, force, true, mean_of);
    move_node(p.a, dv);
  }
  if (!p.is_held()) return;
  const Vec3 impulse = p.mean.mass * dv - dt * (force - loads.damping * p.mean.own * p.mean_of(v));
  for (int axis = 0; axis < 3; ++axis) {
    if (p.hold[axis]) hold_impulse[i][axis] += impulse[axis];
  }
}

/// Rigidly held coordinates that do not move by themselves stand still from now on.
void Structure::Data::stop_rigidly_held() {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& p = points[i];
    hold_impulse[i].setZero();
    for (int axis = 0; axis < 3; ++axis) {
      const Hold* hold = p.hold[axis];
      if (hold == nullptr || !hold->rigid || hold_moves[hold - loads.holds.data()]) continue;
      const double mean = p.mean_of(v)[axis];
      hold_impulse[i][axis] = -p.mean.mass * mean;
      v[p.a][axis] = hold->hinged ? v[p.a][axis] - mean : 0.0;
      if (p.is_pair()) v[p.b][axis] = hold->hinged ? v[p.b][axis] - mean : 0.0;
    }
  }
}

void Structure::Data::set_time(double time, double share) {
  elements.set_time(time, share);
  load_share = share;
  for (std::size_t i = 0; i < loads.holds.size(); ++i) {
    hold_displacement[i] = share * at(loads.holds[i].displacement, time);
  }
  if (loads.forces.empty()) return;
  dead_load.assign(x.size(), Vec3::Zero());
  for (const NodeLoad& load : loads.forces) {
    double volume = 0.0;
    for (const int node : load.nodes) volume += elements.nodal_volume()[node];
    const Vec3 density = share * at(load.force, time) / volume;
    for (const int node : load.nodes) dead_load[node] += elements.nodal_volume()[node] * density;
  }
}

void Structure::Data::estimate_largest_frequency() {
  largest_frequency = std::sqrt(elements.largest_squared_frequency(x, moving_mass));
}

double Structure::Data::stable_step(const Contact* contact) const {
  double squared_frequency = largest_frequency * largest_frequency;
  double damping_rate = loads.stiffness_damping * squared_frequency;
  if (contact) {
    squared_frequency += contact->largest_squared_frequency();
    damping_rate += contact->largest_damping_rate();
  }
  // The positive root of (2 phi - 1) omega^2 dt^2 + 2 c dt = 4.
  const double a = (1.0 + 2.0 * options.dissipation) * squared_frequency, c = damping_rate;
  return options.safety * 4.0 / (c + std::sqrt(c * c + 4.0 * a));
}

/// Of elements, for nodal_force(), at the start of a sub-step. Work is shared.
void Structure::Data::compute_forces() {
  if (loads.stiffness_damping == 0.0) {
    elements.compute_forces(x);
    return;
  }
#pragma omp for schedule(static)
  for (std::size_t node = 0; node < x.size(); ++node) forced_at[node] = x[node] + loads.stiffness_damping * v[node];
  elements.compute_forces(forced_at);
}

double Structure::Data::explicit_substeps(double dt, double stable) const {
  double count = std::max(std::ceil(dt / stable), 1.0);  // in this order, so that what is no number stays none
  if (inertia.reset == 1.0) return count;
  const double phi = 1.0 + options.dissipation, stable_phase = 2.0 * options.safety / std::sqrt(2.0 * phi - 1.0);
  const double of_slow_modes = std::ceil(substeps_between_resets_of_slow_modes(inertia.reset, phi));
  if (of_slow_modes > most_substeps) {
    throw InputError(fmt::format(
        "a dissipation of {:g} would take {:g} sub-steps in every step of the fluid to damp what a solid so "
        "light does; expected at most {:g}: more dissipation, or a denser solid",
        options.dissipation, of_slow_modes, most_substeps));
  }
  count = std::max(count, of_slow_modes);
  while (count <= most_substeps &&
         count < substeps_between_resets(inertia.reset, stable_phase * dt / (count * stable), phi))
    ++count;
  return count;
}

int Structure::Data::substeps_for(double dt, double time, const Contact* contact) {
  const double count = explicit_substeps(dt, stable_step(contact));
  if (count <= most_substeps) return static_cast<int>(count);
  elements.forget_out_of_bounds();
  elements.compute_forces(x);
  if (elements.out_of_bounds()) report_divergence(time);
  const int node = elements.stiffest_node();
  throw Diverged(
      fmt::format("the structure is torn or inverted next to node {} near ({:.4g}, {:.4g}, {:.4g}) m at t = {:.6g} s: "
                  "it would need more than {:g} sub-steps for {:.4g} s",
                  node, x[node].x(), x[node].y(), x[node].z(), time, most_substeps, dt));
}

void Structure::Data::report_divergence(double time) const {
  const auto [group, element, j] = elements.worst();
  const auto nodes = group->nodes_of(element);
  Vec3 centre = Vec3::Zero(), reference_centre = Vec3::Zero();
  for (const int node : nodes) {
    centre += x[node] / static_cast<double>(nodes.size());
    reference_centre += mesh.nodes[node] / static_cast<double>(nodes.size());
  }
  const Vec3& place = centre.allFinite() ? centre : reference_centre;
  throw Diverged(
      fmt::format("the structure is torn or inverted in {} (J = {:.3g}, expected {:g} to {:g}) near "
                  "({:.4g}, {:.4g}, {:.4g}) m at t = {:.6g} s",
                  group->name_of(element), j, options.volume_ratio[0], options.volume_ratio[1], place.x(), place.y(),
                  place.z(), time));
}

/// In common sub-steps, which suit all of them; `contact` between them may be null.
void Structure::Data::advance_explicitly(std::span<Data* const> structures, Contact* contact, double dt, double time) {
  constexpr int interval = 4;  // between looks at how far surfaces have moved, as many of which make up a margin
  for (Data* d : structures) d->estimate_largest_frequency();
  if (contact) {
    contact->watch();
    contact->compute_forces();
  }
  int substeps = 1, threads = 1;
  for (Data* d : structures) {
    substeps = std::max(substeps, d->substeps_for(dt, time, contact));
    threads = std::max(threads, d->elements.threads());
    d->elements.forget_out_of_bounds();
  }
  const double substep = dt / substeps;
  const auto is_torn = [](const Data* d) { return d->elements.out_of_bounds(); };
  int done = 0;
#pragma omp parallel num_threads(threads)
  for (int n = 0; n < substeps; ++n) {
    if (contact && n > 0 && n % interval == 0) contact->watch();
    for (Data* d : structures) {
      if (d->loads_vary) {
#pragma omp single
        d->set_time(time + (n + 1) * substep);
      }
      d->compute_forces();
    }
    if (std::ranges::any_of(structures, is_torn)) break;
    if (contact && n > 0) contact->compute_forces();  // those of the first sub-step are known
#pragma omp single nowait
    done = n + 1;
    for (std::size_t s = 0; s < structures.size(); ++s) {
      Data& d = *structures[s];
      const std::span<const Vec3> push = contact ? contact->forces_on(s) : std::span<const Vec3>();
#pragma omp for schedule(static)
      for (std::size_t point = 0; point < d.points.size(); ++point) {
        d.move(point, push.empty() ? Vec3(Vec3::Zero()) : push[point], substep);
      }
    }
  }
  for (Data* d : structures) {
    if (is_torn(d)) d->report_divergence(time + done * substep);
    d->substeps = substeps;
  }
}

/// Of all holds over a step of `dt`.
void Structure::Data::sum_reaction(double dt) {
  Vec3 impulse = Vec3::Zero();
  for (const Vec3& of_point : hold_impulse) impulse += of_point;
  reaction = impulse / dt;
}

void Structure::advance(double dt, double time) {
  assert(dt > 0.0);
  Data& d = *data_;
  d.stop_rigidly_held();
  if (integrator_for(dt) == Integrator::implicit_scheme) {
    d.advance_implicitly(dt, time);
  } else {
    d.advance_explicitly(std::array{&d}, nullptr, dt, time);
  }
  d.sum_reaction(dt);
}

}  // namespace drogue::fem
