// SPDX-License-Identifier: GPL-3.0-or-later
// The folder a run is written to.
#pragma once

#include <filesystem>
#include <string>

namespace drogue::app {

/// Throws InputError if the folder holds a run, finished or not, unless `force`; says whether it can be continued.
void refuse_other_run(const std::filesystem::path& folder, bool force);

/// Makes the folder and removes what an earlier run left in it; other files stay. Throws InputError if it cannot.
void prepare_run_folder(const std::filesystem::path& folder);

/// Throws InputError if it cannot.
void write_text(const std::filesystem::path& file, const std::string& text);

/// Cuts a text file of a continued run back to the first `count` lines. Throws InputError if it has fewer.
void keep_lines(const std::filesystem::path& file, int count);

}  // namespace drogue::app
