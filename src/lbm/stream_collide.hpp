// SPDX-License-Identifier: GPL-3.0-or-later
// One lattice-Boltzmann step of one block, from the moments of the block and its 26 neighbours to the moments one step
// on.
#pragma once

#include <array>

#include "fluid/specification.hpp"
#include "lbm/layer_sums.hpp"

namespace drogue::lbm {

/// Collision constants of a level.
struct Relaxation {
  double tau;                ///< relaxation time in steps
  double sigma;              ///< hybrid recursive regularised: share of Pneq after streaming, the rest of
                             ///< sigma Pneq - (1 - sigma) 2/3 rho tau S being its finite-difference estimate
  double eddy_factor;        ///< of eddy_viscosity()
  Vec3 kick = Vec3::Zero();  ///< added to the velocity after the step (lbm/body_force.cpp)
};

/// With an eddy viscosity the stress is stored divided by 1 - 1/tau (see BlockKernel::regularise), which must stay away
/// from zero; a level that viscous resolves the flow anyway.
inline constexpr double largest_tau_with_eddy_viscosity = 0.7;

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
  std::array<const std::byte*, 27>
      columns;  ///< MomentField::columns, or null: of those beside it along x, rows are read
  std::byte *target, *target_columns;
  LayerSums<S>* sums = nullptr;              ///< to be given the rows after the step, or null
  bool past_caches = true;                   ///< is the target stored past the caches?
  const BlockNeighbourhood* next = nullptr;  ///< the block after this one, whose rows are prefetched meanwhile
};

/// Advances one block.
template <class S>
using BlockUpdate = BlockRecord (*)(const BlockNeighbourhood<S>&, const Relaxation&);

/// The update of a scheme. Eddy viscosities come with `hrr`, whose gradients they use; throws InputError with others.
template <class S>
BlockUpdate<S> block_update(fluid::Collision collision, fluid::EddyViscosity eddy);

}  // namespace drogue::lbm
