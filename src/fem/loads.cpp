// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/loads.hpp"

#include <algorithm>

namespace drogue::fem {

bool Hold::moves() const {
  return !std::ranges::all_of(displacement,
                              [](const Expression& u) { return u.is_constant() && u(Vec3::Zero(), 0.0) == 0.0; });
}

Vec3 at(const std::array<Expression, 3>& formula, double time) {
  const Vec3 nowhere = Vec3::Zero();
  return {formula[0](nowhere, time), formula[1](nowhere, time), formula[2](nowhere, time)};
}

bool vary(const std::array<Expression, 3>& formula) {
  return std::ranges::any_of(formula, &Expression::depends_on_time);
}

}  // namespace drogue::fem
