// SPDX-License-Identifier: GPL-3.0-or-later
// Floating-point operations of a cell update, counted by running the kernel's own formulas on numbers that count. What
// is computed once more for the halo of a block is left out.
#pragma once

#include "fluid/specification.hpp"

namespace drogue::bench {

/// Additions, multiplications, divisions, roots and maxima; a fused multiply-add is two.
int flops_per_update(fluid::Collision collision, fluid::EddyViscosity eddy);

}  // namespace drogue::bench
