// SPDX-License-Identifier: GPL-3.0-or-later
// Regularised delta functions between markers and the finest grid level (Peskin, Acta Numerica 11 (2002) 479; Roma, Peskin
// & Berger, J. Comput. Phys. 153 (1999) 509). Interpolation and spreading are adjoint and give the same bits for any
// number of threads: interpolation writes per marker, spreading per block, each in a fixed order.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "fluid/views.hpp"

namespace drogue::ib {

enum class Delta { peskin4, peskin3 };

/// Sum of phi^2 over the grid points of one axis, independent of position: 3/8 (four-point), 1/2 (three-point). A sheet
/// of markers drags the fluid mass rho dx / sum_phi_squared per area (Gsell & Favier, J. Comput. Phys. 429 (2021)).
double sum_phi_squared(Delta delta);

class Markers {
 public:
  /// `body` names the owner in error messages.
  Markers(const amr::Forest& forest, Delta delta, std::string body);

  /// Moves the markers; throws InputError if one does not lie in finest-level blocks with the delta's margin, naming it.
  void move_to(std::span<const Vec3> position);

  /// U_l = sum_x u(x) delta(x - X_l) dx^3 [m/s].
  void interpolate(const fluid::VelocityView& u, std::span<Vec3> out) const;
  /// The same for a force density [N/m^3]; blocks that are not open count as zero.
  void interpolate(const fluid::ForceField& f, std::span<Vec3> out) const;
  /// f(x) += sum_l F_l delta(x - X_l), F_l in [N]; opens the blocks it needs.
  void spread(std::span<const Vec3> force, fluid::ForceField& f) const;
};

}  // namespace drogue::ib
