// SPDX-License-Identifier: GPL-3.0-or-later
// Elastic laws, one small struct each: energy per reference volume, stress, tangent. A new one is added to the list of
// the elements that can be made of it.
#pragma once

#include <variant>

#include "fem/fabric_tension_field.hpp"
#include "fem/linear_cable.hpp"
#include "fem/neo_hookean.hpp"
#include "fem/orthotropic_fabric.hpp"
#include "fem/plane_neo_hookean.hpp"
#include "fem/plane_saint_venant_kirchhoff.hpp"
#include "fem/saint_venant_kirchhoff.hpp"
#include "fem/tension_field.hpp"

namespace drogue::fem {

/// Of solids: functions of the deformation gradient.
using Material = std::variant<NeoHookean, SaintVenantKirchhoff>;

/// Of membranes: functions of the right Cauchy-Green tensor in their plane, the stress across vanishing.
using MembraneMaterial =
    std::variant<PlaneNeoHookean, PlaneSaintVenantKirchhoff, OrthotropicFabric, TensionField<PlaneNeoHookean>,
                 TensionField<PlaneSaintVenantKirchhoff>, TensionField<OrthotropicFabric>>;

}  // namespace drogue::fem
