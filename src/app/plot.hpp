// SPDX-License-Identifier: GPL-3.0-or-later
// `drogue plot`: what a run gave, against the references of its case.
#pragma once

#include <filesystem>
#include <string>

namespace drogue::app {

/// Draws what the case is about (drag and displacement of bodies, dissipation, errors, profiles) into `picture`;
/// plot.png in the folder of the run if that is empty. Returns what to tell the user. Throws InputError if the folder
/// holds no run or something in it cannot be read.
std::string plot_run(const std::filesystem::path& folder, std::filesystem::path picture);

}  // namespace drogue::app
