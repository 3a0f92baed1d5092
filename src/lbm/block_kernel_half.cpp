// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/block_kernel.hpp"

namespace drogue::lbm {

#ifdef __F16C__
template BlockUpdate<HalfStress> block_update(fluid::Collision, fluid::EddyViscosity);
#endif

}  // namespace drogue::lbm
