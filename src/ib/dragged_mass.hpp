// SPDX-License-Identifier: GPL-3.0-or-later
// The fluid mass a marker drags through its delta function. Forces F_l that act over dt change the interpolated
// velocity by
//   dU_k = dt / rho sum_l K_kl F_l,   K_kl = sum_x delta(x - X_k) delta(x - X_l) dx^3,
// so the impulse M_l (v_l - u*_l) brings U to v exactly where the row sums of K diag(M) / rho are one. K is positive
// semi-definite with entries >= 0 for both kernels, hence row sums of one bound every other gain by [0, 1]: no mode is
// ever over-corrected, which is what makes both direct forcing and the coupling stable (Gsell & Favier, J. Comput.
// Phys. 429 (2021); Pinelli et al., J. Comput. Phys. 229 (2010) 9073, solve for such weights; here they follow in
// closed form). Row sums are taken in the reference position: a body squeezed to a fraction of its area has gains above
// one.
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "ib/delta.hpp"
#include "ib/markers.hpp"

namespace drogue::ib {

/// Markers of a sheet that each own `area` [m^2], with the grid `spacing` [m] and the fluid `density` [kg/m^3]:
/// M = rho A dx / sum_phi_squared [kg].
std::vector<double> mass_dragged_by_sheet(Delta delta, std::span<const double> area, double spacing, double density);

/// Markers of any cloud that each own `volume` [m^3]: M_l = rho V_l / sum_k K_lk V_k [kg], with K averaged over the
/// places of the grid. That is rho V_l inside a volume that is sampled at least as finely as the grid, twice as much at
/// its plane faces, the value above for a single layer, rho L (dx / sum_phi_squared)^2 for the length L of a straight
/// line, rho (dx / sum_phi_squared)^3 for a marker on its own, and nothing for one without volume.
std::vector<double> mass_dragged_by_cloud(Delta delta, std::span<const Vec3> position, std::span<const double> volume,
                                          double spacing, double density);

/// Markers that stand on the grid, with K as it is there, across periodic sides too: the row sums themselves are
/// brought close to one, by M_l <- M_l rho / sum_k K_lk M_k from M = `volume` on, which keeps M positive. It piles up
/// at edges.
std::vector<double> mass_dragged(const Markers& markers, const amr::Forest& forest, std::span<const double> volume,
                                 double density);

}  // namespace drogue::ib
