// SPDX-License-Identifier: GPL-3.0-or-later
// `drogue bench accuracy`: the error of flows with a known solution against the time that it takes, over resolution,
// lattice velocity (and with it the Mach number) and collision operator; which settings are worth it, and which is the
// cheapest that keeps a given error.
#pragma once

#include <string>
#include <vector>

#include "bench/options.hpp"
#include "bench/report.hpp"

namespace drogue::bench {

/// Writes accuracy_NAME.csv for each flow and accuracy.png. Rows that a table has are not run again; each run leaves
/// its folder below runs/. Throws InputError.
Report measure_accuracy(const Options& options);

/// Names that Options::only may hold for it.
std::vector<std::string> accuracy_parts();

}  // namespace drogue::bench
