// SPDX-License-Identifier: GPL-3.0-or-later
// Other programs: gmsh, gnuplot.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drogue {

/// Runs a program that is looked for in PATH, its output into `log`, and returns its exit status, or `not_installed`.
int run_program(std::vector<std::string> words, const std::filesystem::path& log);

inline constexpr int not_installed = 127;

}  // namespace drogue
