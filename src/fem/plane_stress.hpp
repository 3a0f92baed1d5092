// SPDX-License-Identifier: GPL-3.0-or-later
// The thickness a thin sheet takes when nothing presses on its faces.
#pragma once

#include <array>
#include <span>

#include "core/types.hpp"
#include "fem/material.hpp"

namespace drogue::fem {

/// Stretch across a sheet that makes the normal stress there vanish, P_33(diag(a, b, t)) = 0, for the principal
/// stretches `a` and `b` in its plane; 0 where the law has no such state (Saint Venant-Kirchhoff stretched beyond its
/// range).
double plane_stress_thickness(const Material& material, double a, double b);

/// Stretches at the centre of a hexahedron that is thin along parent direction `thickness`.
struct SheetStretch {
  double thickness;                ///< across the deformed sheet
  std::array<double, 2> in_plane;  ///< principal
};
SheetStretch sheet_stretch(const std::array<int, 8>& element, int thickness, std::span<const Vec3> reference,
                           std::span<const Vec3> x);

}  // namespace drogue::fem
