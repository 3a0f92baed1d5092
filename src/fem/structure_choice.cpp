// SPDX-License-Identifier: GPL-3.0-or-later
// Which method is cheaper, from counts alone, so that a case has the same choice on every machine and for any number of
// threads. Costs are in nanoseconds of the machine of docs/benchmarks.md, where they were measured; only their ratios
// matter.
#include <algorithm>
#include <cmath>
#include <vector>

#include "fem/structure_data.hpp"

namespace drogue::fem {
namespace {

constexpr double per_force = 10.0;         // on a node by an element
constexpr double per_entry = 10.0;         // of the tangent of an element, computed and summed
constexpr double per_operation = 0.3;      // of a factorisation
constexpr double implicit_iterations = 4;  // of a step
constexpr double newton_iterations = 15;   // to an equilibrium
constexpr double crossings = 60;           // of the body by a wave, to an equilibrium by relaxation

/// Number of elements in a row from the node furthest from node 0 to the one furthest from that; parts that hang
/// together with neither do not count.
int elements_across(const Elements& elements, std::size_t nodes) {
  std::vector<std::vector<int>> neighbours(nodes);
  for (const auto& group : elements.groups()) {
    for (int e = 0; e < group->count(); ++e) {
      for (const int a : group->nodes_of(e)) {
        for (const int b : group->nodes_of(e)) neighbours[a].push_back(b);
      }
    }
  }
  int start = 0, distance = 0;
  for (int sweep = 0; sweep < 2; ++sweep) {
    std::vector<int> away(nodes, -1), reached{start};
    away[start] = 0;
    for (std::size_t k = 0; k < reached.size(); ++k) {
      for (const int node : neighbours[reached[k]]) {
        if (away[node] >= 0) continue;
        away[node] = away[reached[k]] + 1;
        reached.push_back(node);
      }
    }
    start = reached.back();
    distance = away[start];
  }
  return distance;
}

}  // namespace

bool Structure::Data::needs_explicit_motion() const {
  return loads.contact || loads.stiffness_damping > 0.0 || std::ranges::any_of(loads.holds, &Hold::hinged);
}

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
  if (d.needs_explicit_motion()) return Integrator::explicit_scheme;
  const double explicit_cost = d.explicit_substeps(dt, d.reference_step) * d.cost_of_forces();
  const bool may_pay = explicit_cost > implicit_iterations * 2.0 * d.cost_of_forces();  // spares the factorisation
  return may_pay && implicit_iterations * d.cost_of_newton() < explicit_cost ? Integrator::implicit_scheme
                                                                             : Integrator::explicit_scheme;
}

Equilibrium Structure::cheaper_equilibrium() const {
  Data& d = *data_;
  const double relaxation_cost = crossings * elements_across(d.elements, d.x.size()) * d.cost_of_forces();
  return newton_iterations * d.cost_of_newton() < relaxation_cost ? Equilibrium::newton : Equilibrium::relaxation;
}

}  // namespace drogue::fem
