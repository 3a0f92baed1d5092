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

/// Change of the velocity `v` of a held coordinate at `x`, with reference `reference`, under the elastic force `f`.
Vec3 held_velocity_change(const Hold& hold, const Inertance& inertance, const Vec3& f, const Vec3& x,
                          const Vec3& reference, const Vec3& v, double dt) {
  if (hold.rigid) return Vec3::Zero();
  const double kick = dt / inertance.mass, stiffness = hold.stiffness * inertance.volume;
  const double resistance = 1.0 + kick * (hold.damping * inertance.volume + dt * stiffness);
  return (v + kick * (f + stiffness * (reference - x))) / resistance - v;
}

}  // namespace

void Structure::Data::move(std::size_t i, double dt) {
  const Point& p = points[i];
  // `of` takes the coordinate out of a nodal field.
  const auto velocity_change = [&](const Inertance& inertance, const Vec3& f, const auto& of) -> Vec3 {
    if (p.hold == nullptr) return dt / inertance.mass * f;
    return held_velocity_change(*p.hold, inertance, f, of(x), of(mesh.nodes), of(v), dt);
  };
  const auto move_node = [&](int node, const Vec3& dv) {
    x[node] += dt * (v[node] + (1.0 + options.dissipation) * dv);
    v[node] += dv;
  };
  const auto mean_of = [&p](const std::vector<Vec3>& field) { return p.mean_of(field); };
  Vec3 force = elements.nodal_force(p.a), dv;
  if (p.is_pair()) {
    const Vec3 force_b = elements.nodal_force(p.b);
    const Vec3 dv_difference = velocity_change(p.difference, p.share_b * force - p.share_a * force_b,
                                               [&p](const auto& field) -> Vec3 { return field[p.a] - field[p.b]; });
    force += force_b;
    dv = velocity_change(p.mean, force, mean_of);
    move_node(p.a, dv + p.share_b * dv_difference);
    move_node(p.b, dv - p.share_a * dv_difference);
  } else {
    dv = velocity_change(p.mean, force, mean_of);
    move_node(p.a, dv);
  }
  if (p.hold != nullptr) hold_impulse[i] += p.mean.mass * dv - dt * force;
}

void Structure::Data::stop_rigidly_held() {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& p = points[i];
    hold_impulse[i].setZero();
    if (p.hold == nullptr || !p.hold->rigid) continue;
    hold_impulse[i] = -p.mean.mass * p.mean_of(v);
    v[p.a].setZero();
    if (p.is_pair()) v[p.b].setZero();
  }
}

void Structure::Data::estimate_largest_frequency() {
#pragma omp parallel num_threads(elements.threads())
  elements.stiffness_bounds(x, lightness, stiffness_bounds);
  const double stiffest = *std::max_element(stiffness_bounds.begin(), stiffness_bounds.end());
  largest_frequency = std::sqrt(stiffest / options.density);
}

double Structure::Data::stable_step() const {
  return options.safety * 2.0 / (std::sqrt(1.0 + 2.0 * options.dissipation) * largest_frequency);
}

int Structure::Data::substeps_for(double dt) const {
  // Far beyond any useful count: a state that asks for more is on its way out of the bounds of J.
  constexpr int most = 1'000'000;
  const double count = std::ceil(dt / stable_step());
  return count < most ? std::max(1, static_cast<int>(count)) : most;
}

void Structure::Data::report_divergence(double time) const {
  const auto [element, j] = elements.worst();
  Vec3 centre = Vec3::Zero(), reference_centre = Vec3::Zero();
  for (const int node : mesh.elements[element]) {
    centre += x[node] / 8.0;
    reference_centre += mesh.nodes[node] / 8.0;
  }
  const Vec3& place = centre.allFinite() ? centre : reference_centre;
  throw Diverged(
      fmt::format("the structure is torn or inverted in element {} (J = {:.3g}, expected {:g} to {:g}) near "
                  "({:.4g}, {:.4g}, {:.4g}) m at t = {:.6g} s",
                  element, j, options.volume_ratio[0], options.volume_ratio[1], place.x(), place.y(), place.z(), time));
}

void Structure::advance(double dt, double time) {
  assert(dt > 0.0);
  Data& d = *data_;
  d.estimate_largest_frequency();
  d.substeps = d.substeps_for(dt);
  d.stop_rigidly_held();
  d.elements.forget_out_of_bounds();
  const double substep = dt / d.substeps;
  int done = 0;
#pragma omp parallel num_threads(d.elements.threads())
  for (int n = 0; n < d.substeps; ++n) {
    d.elements.compute_forces(d.x);
    if (d.elements.out_of_bounds()) break;
#pragma omp single nowait
    done = n + 1;
#pragma omp for schedule(static)
    for (std::size_t point = 0; point < d.points.size(); ++point) d.move(point, substep);
  }
  if (d.elements.out_of_bounds()) d.report_divergence(time + done * substep);

  Vec3 impulse = Vec3::Zero();
  for (const Vec3& of_point : d.hold_impulse) impulse += of_point;
  d.reaction = impulse / dt;
}

}  // namespace drogue::fem
