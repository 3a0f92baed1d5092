// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/body_keys.hpp"

#include <fmt/format.h>

#include <cmath>

namespace drogue::app {

std::string read_name(Section& body) {
  return body.get<std::string>("name", {.doc = "for keys, messages and columns"});
}

double read_reference_area(Section& body, const std::optional<double>& area) {
  return body.get<double>("reference_area", {.unit = "m^2",
                                             .doc = "of the drag coefficient; by default that of a plate or a shape",
                                             .derived = area,
                                             .range = positive});
}

ib::Delta read_delta(Section& coupling) {
  const Choices<ib::Delta> deltas{{"peskin4", ib::Delta::peskin4}, {"peskin3", ib::Delta::peskin3}};
  return coupling.choose("delta", deltas, {.doc = "regularised delta function", .fallback = "peskin4"});
}

Formulas read_formulas_of_time(Section& section, const std::string& name, const Key<Formulas>& key) {
  const Formulas formulas = section.get<Formulas>(name, key);
  for (const Expression& formula : formulas) expect_time_alone(section, name, formula);
  return formulas;
}

void expect_time_alone(const Section& section, const std::string& name, const Expression& formula) {
  if (formula.depends_on_place()) {
    section.fail(name, fmt::format("= \"{}\" depends on the place; expected a formula in t alone", formula.text()));
  }
  if (!std::isfinite(formula(Vec3::Zero(), 0.0))) {
    section.fail(name, fmt::format("= \"{}\" is not finite at t = 0", formula.text()));
  }
}

}  // namespace drogue::app
