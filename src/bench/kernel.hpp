// SPDX-License-Identifier: GPL-3.0-or-later
// `drogue bench kernel`: how many cells the fluid updates a second, by collision operator, storage and threads, from
// main memory and in cache; what binds it; and what eddy viscosity, force and refinement cost.
#pragma once

#include "bench/options.hpp"
#include "bench/report.hpp"

namespace drogue::bench {

/// Writes kernel.csv, kernel_costs.csv, kernel_floors.csv and kernel.png. The threads that OpenMP has now are the most
/// that are used. Throws InputError.
Report measure_kernel(const Options& options);

}  // namespace drogue::bench
