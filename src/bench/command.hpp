// SPDX-License-Identifier: GPL-3.0-or-later
// `drogue bench`: how fast, how accurate for the time, how stable.
#pragma once

#include <string>
#include <vector>

namespace drogue::bench {

/// Runs the families that `arguments` (without "bench") ask for and returns the exit code. Throws InputError.
int run_command(std::vector<std::string> arguments);

}  // namespace drogue::bench
