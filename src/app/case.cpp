// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/case.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::app {

bool in_flow(const Body& body) { return body.in_flow; }
bool is_elastic(const Body& body) { return std::holds_alternative<ElasticBody>(body.kind); }
bool is_elastic_in_flow(const Body& body) { return is_elastic(body) && body.in_flow; }
bool is_rigid(const Body& body) { return std::holds_alternative<RigidBody>(body.kind); }
const std::vector<Probe>& probes_of(const Body& body) {
  static const std::vector<Probe> none;
  const auto* elastic = std::get_if<ElasticBody>(&body.kind);
  return elastic ? elastic->probes : none;
}

const char* unit_of(const Probe& probe) { return probe.scale == 1.0 ? "m" : "1"; }

bool has_wake(const Body& body) {
  const auto* rigid = std::get_if<RigidBody>(&body.kind);
  return rigid && rigid->shape.width > 0.0 && rigid->motion.is_still();
}

bool measures_energy(const Case& c) { return c.measure.energy; }
bool measures_error(const Case& c) { return c.measure.exact_velocity.has_value(); }
bool measures_residual(const Case& c) { return c.measure.residual.has_value(); }

int level_of(double coarsest, double spacing) {
  const double level = std::log2(coarsest / spacing);
  const double nearest = std::round(level);
  return nearest >= 0.0 && std::abs(level - nearest) < 1e-9 ? static_cast<int>(nearest) : amr::none;
}

const Body* summarised_body(const Case& c) {
  const auto body = std::ranges::find(c.bodies, c.results.body, &Body::name);
  return body == c.bodies.end() ? nullptr : &*body;
}

double time_step(const Case& c, int level) {
  return c.fluid.lattice_velocity * std::ldexp(c.domain.coarsest, -level) / c.fluid.reference_velocity;
}

double relaxation_time(const Case& c, int level) {
  const double dx = std::ldexp(c.domain.coarsest, -level);
  return 0.5 + 3.0 * c.fluid.viscosity * time_step(c, level) / (dx * dx);
}

/// The lattice-Boltzmann fluid yields to a force that varies from cell to cell by (1 - tau) / (2 nu) more than the
/// second difference says (docs/theory.md).
double wall_offset(const Case& c, ib::Delta delta) {
  const double tau = relaxation_time(c, level_of(c.domain.coarsest, c.finest));
  return ib::wall_offset(delta) + 0.5 * (1.0 - tau) * ib::sum_phi_squared(delta);
}

Vec3 flow_direction(const Case& c) {
  const Vec3 middle = 0.5 * (c.domain.box.lower + c.domain.box.upper);
  for (int face = 0; face < 6; ++face) {
    if (c.fluid.face[face].type != fluid::Boundary::velocity) continue;
    Vec3 centre = middle;
    centre[face / 2] = (face % 2 == 0 ? c.domain.box.lower : c.domain.box.upper)[face / 2];
    Vec3 velocity;
    for (int axis = 0; axis < 3; ++axis) velocity[axis] = c.fluid.face[face].velocity[axis](centre, c.end);
    if (velocity.norm() > 0.0) return velocity.normalized();
  }
  return Vec3::UnitX();
}

}  // namespace drogue::app
