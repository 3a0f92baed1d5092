// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/touching_structures.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/error.hpp"
#include "fem/structure_data.hpp"

namespace drogue::fem {
namespace {

std::vector<Structure::Data*> data_of(const std::vector<Structure*>& structures) {
  std::vector<Structure::Data*> all;
  for (Structure* structure : structures) {
    all.push_back(&structure->data());
    if (all.back()->options.integrator == Integrator::implicit_scheme) {
      throw InputError("implicit motion knows no contact; expected explicit motion");
    }
  }
  return all;
}

Contact make_contact(const std::vector<Structure::Data*>& structures, const ContactOptions& options) {
  std::vector<ContactBody> bodies;
  double frequency = 0.0;
  for (const Structure::Data* d : structures) {
    bodies.push_back({d->mesh, d->regions, d->points, d->x, d->v});
    frequency = std::max(frequency, d->largest_frequency);
  }
  return Contact(options, bodies, std::pow(frequency, 2));
}

}  // namespace

TouchingStructures::TouchingStructures(std::vector<Structure*> structures, const ContactOptions& options)
    : structures_(data_of(structures)), contact_(make_contact(structures_, options)) {}

void TouchingStructures::advance(double dt, double time) {
  assert(dt > 0.0);
  for (Structure::Data* d : structures_) d->stop_rigidly_held();
  Structure::Data::advance_explicitly(structures_, &contact_, dt, time);
  for (Structure::Data* d : structures_) d->sum_reaction(dt);
}

double TouchingStructures::stable_step() const {
  double step = INFINITY;
  for (const Structure::Data* d : structures_) step = std::min(step, d->stable_step(&contact_));
  return step;
}

}  // namespace drogue::fem
