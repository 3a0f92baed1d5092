// SPDX-License-Identifier: GPL-3.0-or-later
// `drogue bench stability`: which runs survive, over Reynolds number, lattice velocity and collision operator for three
// under-resolved flows, and over mass, stiffness and sudden events for an elastic sheet. Runs are small, so each has
// one thread, and as many are made at once as there are threads.
#pragma once

#include <string>
#include <vector>

#include "bench/options.hpp"
#include "bench/report.hpp"

namespace drogue::bench {

/// Writes a table and a map of each flow, stability_NAME.csv and .png; reports how many runs had which outcome. Rows
/// that a table has are not run again. Throws InputError.
Report measure_stability(const Options& options);

/// Names that Options::only may hold for it.
std::vector<std::string> stability_parts();

}  // namespace drogue::bench
