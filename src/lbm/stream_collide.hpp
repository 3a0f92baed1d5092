// SPDX-License-Identifier: GPL-3.0-or-later
// One lattice-Boltzmann step of one block, from the moments of the block and its 26 neighbours to the moments one step
// on.
#pragma once

#include <array>

#include "lbm/moments.hpp"

namespace drogue::lbm {

/// Collision constants of a level. Hybrid recursive regularised: Pneq after streaming is blended with its
/// finite-difference estimate, sigma Pneq - (1 - sigma) 2/3 rho tau S.
struct Relaxation {
  float tau;    ///< relaxation time in steps
  float sigma;  ///< 1: recursive regularised

  static Relaxation of_viscosity(double lattice_viscosity, double sigma) {
    return {static_cast<float>(0.5 + 3.0 * lattice_viscosity), static_cast<float>(sigma)};
  }
};

/// Bounds beyond which a cell counts as diverged.
inline constexpr float speed_limit = 0.45f;   ///< |u| in cells per step
inline constexpr float density_limit = 0.6f;  ///< |rho - 1|

struct BlockRecord {
  float max_speed_squared = 0.0f;  ///< after the step
  bool diverged = false;           ///< a cell left the bounds, or is not a number
};

template <class S>
struct BlockNeighbourhood {
  std::array<const std::byte*, 27> source;  ///< by amr::neighbour_slot; the rims that face the block must be filled
  std::byte* target;
  const BlockNeighbourhood* next = nullptr;  ///< the block after this one, whose rows are prefetched meanwhile
};

/// Advances one block. Instantiated for HalfStress and FloatStress.
template <class S>
BlockRecord stream_collide(const BlockNeighbourhood<S>& blocks, const Relaxation& relaxation);

}  // namespace drogue::lbm
