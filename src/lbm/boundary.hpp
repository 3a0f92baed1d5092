// SPDX-License-Identifier: GPL-3.0-or-later
// Domain faces: every condition is a rule that fills the layer of cells beyond the face from the layer before it, with
// the face half-way between. Mirror images conserve mass exactly along walls and in corners of free-slip walls; where
// no-slip walls meet, to the difference of populations along them:
//   free slip   u_n and the shear stresses with one normal index change sign (specular reflection)
//   no slip     u -> 2 u_wall - u (bounce-back seen from the moments)
//   velocity    u -> 2 u_face - u
//   outlet      u kept, p -> 2 p_face - p
// drho and Pneq are kept where nothing else is said. Cells beyond two or three faces are mirrored once per face, x
// first; in an edge between two faces that fix the velocity only once, which is what bounce-back does to the population
// that crosses the edge.
#pragma once

#include <vector>

#include "fluid/specification.hpp"
#include "lbm/moments.hpp"

namespace drogue::lbm {

/// From SI to lattice units; the same on every level (acoustic scaling).
struct Units {
  double velocity;  ///< [m/s] of one cell per step
  double pressure;  ///< [Pa] of drho = 1: rho c_s^2
};

template <class S>
class BoundaryFill {
 public:
  BoundaryFill(const amr::Forest& forest, const fluid::Specification& specification, const Units& units);

  /// Fills the boundary blocks of `level` at `time` [s]; leaves and ghosts of the level must be up to date.
  void operator()(int level, double time, MomentField<S>& field);

 private:
  struct Item {
    int target, source, axis, face;
    int table;         // of velocities; -1 where one value does
    bool beyond_wall;  // the source is already the image in another wall
  };
  using Real = typename S::Real;
  using VelocityTable = std::vector<std::array<Vec<Real>, 3>>;  // per line of the layer, lattice units

  void update_table(const Item& item, double time);
  Row<Real> reflect(const Item& item, const Row<Real>& inside, int line, double ramp) const;

  const amr::Forest& forest_;
  const fluid::Specification& specification_;
  const Units units_;
  std::vector<std::vector<std::vector<Item>>> items_;  // [level][faces beyond which the block lies - 1]
  std::vector<VelocityTable> tables_;
};

}  // namespace drogue::lbm
