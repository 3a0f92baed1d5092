// SPDX-License-Identifier: GPL-3.0-or-later
// The command line: what each command takes, and which function it calls.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace drogue::app {

/// Parses the arguments (program name left out); an exit code if they only ask for help or the version. Throws
/// InputError.
std::optional<int> parse(CLI::App& app, std::vector<std::string> arguments);

/// Adds --threads.
void add_threads(CLI::App& command, std::optional<int>& threads);

/// Runs the command that `arguments` (program name left out) ask for and returns the exit code. Throws InputError and
/// Diverged. `program` is how the executable was called: drogue-render is looked for beside it.
int run_command(const std::string& program, std::vector<std::string> arguments);

}  // namespace drogue::app
