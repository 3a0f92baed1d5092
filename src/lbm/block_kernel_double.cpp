// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/block_kernel.hpp"

namespace drogue::lbm {

template BlockUpdate<DoubleStress> block_update(fluid::Collision, fluid::EddyViscosity);

}  // namespace drogue::lbm
