// SPDX-License-Identifier: GPL-3.0-or-later
// Hyperelastic laws, one small struct each: energy per reference volume, first Piola-Kirchhoff stress, tangent.
#pragma once

#include <variant>

#include "fem/neo_hookean.hpp"
#include "fem/saint_venant_kirchhoff.hpp"

namespace drogue::fem {

using Material = std::variant<NeoHookean, SaintVenantKirchhoff>;

}  // namespace drogue::fem
