// SPDX-License-Identifier: GPL-3.0-or-later
// What eddy viscosity, a force and interfaces between levels cost the blocks that have them.
#pragma once

#include "bench/rate.hpp"
#include "bench/result_table.hpp"
#include "io/plot.hpp"

namespace drogue::bench {

/// Appends rows (feature, threads, share of all updates that are in blocks with the feature, rate over the rate without
/// it, relative cost of such a block). Changes the number of threads that OpenMP uses.
void measure_costs(bool quick, const Patience& patience, ResultTable& table);

/// Rate over the uniform rate by number of levels, for each number of threads.
io::Plot plot_of_levels(const ResultTable& costs);

}  // namespace drogue::bench
