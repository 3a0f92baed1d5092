// SPDX-License-Identifier: GPL-3.0-or-later
// The folder a run is written to.
#pragma once

#include <filesystem>

namespace drogue::app {

/// Throws InputError if the folder holds a run, finished or not, unless `force`.
void refuse_other_run(const std::filesystem::path& folder, bool force);

/// Makes the folder and removes what an earlier run left in it; other files stay. Throws InputError if it cannot.
void prepare_run_folder(const std::filesystem::path& folder);

}  // namespace drogue::app
