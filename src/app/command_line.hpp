// SPDX-License-Identifier: GPL-3.0-or-later
// The command line: what each command takes, and which function it calls.
#pragma once

#include <string>
#include <vector>

namespace drogue::app {

/// Runs the command that `arguments` (program name left out) ask for and returns the exit code. Throws InputError and
/// Diverged. `program` is how the executable was called: drogue-render is looked for beside it.
int run_command(const std::string& program, std::vector<std::string> arguments);

}  // namespace drogue::app
