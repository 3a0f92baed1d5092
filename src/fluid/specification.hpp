// SPDX-License-Identifier: GPL-3.0-or-later
// What a case says about its fluid, in SI; plain data, already validated.
#pragma once

#include <array>
#include <optional>

#include "core/expression.hpp"
#include "core/types.hpp"

namespace drogue::fluid {

enum class Boundary { velocity, outlet, free_slip, no_slip, periodic };

/// Faces are numbered x_min, x_max, y_min, y_max, z_min, z_max.
struct Face {
  Boundary type = Boundary::periodic;
  std::array<Expression, 3> velocity;  ///< [m/s], functions of x, y, z, t; for `velocity` (and a moving `no_slip` wall)
  double ramp = 0.0;                   ///< [s] time over which the velocity rises (cosine) from zero
  double pressure = 0.0;               ///< gauge [Pa]; for `outlet`
  bool reflecting = false;             ///< does sound come back from a `velocity` face or an `outlet`?
  double sponge =
      0.0;  ///< [m] depth of a layer that damps towards the initial velocity and the face's pressure; 0: none
};

/// How the lattice-Boltzmann fluid relaxes its stress.
enum class Collision {
  bgk,  ///< single relaxation time, second-order equilibrium
  rr,   ///< recursive regularised: third-order terms follow from lower moments
  hrr,  ///< the same, the stress blended with its finite-difference estimate
};

/// Model of the turbulence that the grid does not resolve.
enum class EddyViscosity { none, vreman, wale, smagorinsky };

/// Floating-point types of the state: float32 with 16-bit stresses, all float32, all float64.
enum class Storage { half_stress, float32, float64 };

struct Specification {
  double density;                  ///< [kg/m^3]
  double viscosity;                ///< kinematic [m^2/s]
  double reference_velocity;       ///< [m/s] the velocity that `lattice_velocity` stands for
  double lattice_velocity = 0.05;  ///< reference velocity in cells per time step, the same on every level
  Collision collision = Collision::hrr;
  double hrr_sigma = 0.98;  ///< share of the projected stress; the rest is finite differences
  EddyViscosity eddy_viscosity = EddyViscosity::none;
  double eddy_constant = 0.0;  ///< of the model (lbm/eddy_viscosity.hpp)
  Storage storage = Storage::half_stress;
  std::array<Face, 6> face;
  std::array<Expression, 3> force;             ///< on the whole fluid [N/m^3], functions of t
  std::array<Expression, 3> initial_velocity;  ///< [m/s] functions of x, y, z (t = 0)
  std::optional<Expression> initial_pressure;  ///< gauge [Pa]; zero if absent
};

}  // namespace drogue::fluid
