// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elastic_moduli.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"

namespace drogue::fem {
namespace {

void check_poisson(double poisson) {
  if (!(poisson > -1.0 && poisson < 0.5)) {
    throw InputError(fmt::format("Poisson's ratio is {}; expected more than -1 and less than 0.5", poisson));
  }
}

}  // namespace

double shear_modulus(double young, double poisson) {
  if (!(young > 0.0 && std::isfinite(young))) {
    throw InputError(fmt::format("Young's modulus is {} Pa; expected a positive number", young));
  }
  check_poisson(poisson);
  return young / (2.0 * (1.0 + poisson));
}

double bulk_modulus(double shear, double poisson) {
  check_poisson(poisson);
  return 2.0 * shear * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson));
}

}  // namespace drogue::fem
