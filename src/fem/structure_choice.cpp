// SPDX-License-Identifier: GPL-3.0-or-later
// Which method is cheaper, from counts alone, so that a case has the same choice on every machine and for any number of
// threads. The unit is a multiplication in the factorisation of a sparse matrix, about a nanosecond; docs/benchmarks.md
// has what the costs were measured with.
#include <algorithm>
#include <cmath>

#include "fem/structure_data.hpp"

namespace drogue::fem {
namespace {

constexpr double per_force = 10.0;         // on a node by an element
constexpr double per_entry = 1.0;          // of the tangent of an element, computed and summed
constexpr double per_operation = 1.0;      // of a factorisation
constexpr double implicit_iterations = 4;  // of a step
constexpr double newton_iterations = 25;   // to an equilibrium
constexpr double crossings = 60;           // of the body by a wave, to an equilibrium by relaxation

}  // namespace

double Structure::Data::cost_of_forces() const {
  double forces = 0.0;
  for (const ForceGroup* group : elements.force_groups()) forces += group->count() * group->nodes_per_element();
  return per_force * forces;
}

/// Of one iteration.
double Structure::Data::cost_of_newton() {
  double entries = 0.0;
  for (const ForceGroup* group : elements.force_groups()) {
    entries += group->count() * std::pow(3.0 * group->nodes_per_element(), 2);
  }
  return per_entry * entries + per_operation * newton().operations() + 2.0 * cost_of_forces();
}

Integrator Structure::integrator_for(double dt) const {
  Data& d = *data_;
  if (d.options.integrator != Integrator::cheaper) return d.options.integrator;
  if (std::ranges::any_of(d.loads.holds, &Hold::hinged)) return Integrator::explicit_scheme;
  const double explicit_cost = d.substeps_for(dt, d.reference_frequency) * d.cost_of_forces();
  const bool may_pay = explicit_cost > implicit_iterations * 2.0 * d.cost_of_forces();  // spares the factorisation
  return may_pay && implicit_iterations * d.cost_of_newton() < explicit_cost ? Integrator::implicit_scheme
                                                                             : Integrator::explicit_scheme;
}

Equilibrium Structure::cheaper_equilibrium() const {
  Data& d = *data_;
  const double across = d.elements.count();  // TODO
  const double relaxation_cost = crossings * across * d.cost_of_forces();
  return newton_iterations * d.cost_of_newton() < relaxation_cost ? Equilibrium::newton : Equilibrium::relaxation;
}

}  // namespace drogue::fem
