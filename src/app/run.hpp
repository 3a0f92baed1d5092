// SPDX-License-Identifier: GPL-3.0-or-later
// `drogue run`: one case from its file to its summary.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drogue::app {

struct RunOptions {
  std::filesystem::path path;          ///< case folder or file
  std::filesystem::path folder;        ///< of the run; runs/NAME if empty
  std::vector<std::string> overrides;  ///< "key=value"
  std::optional<int> threads;
  std::optional<double> until;  ///< [s] instead of time.end
  bool force = false, quiet = false;
  bool resume = false;  ///< go on in `folder` from the newest checkpoint there
};

/// Returns the exit code: 0, or 130 if interrupted. Throws InputError and Diverged; what was written so far is kept,
/// checkpoints included, and the summary says how the run ended.
int run_case(const RunOptions& options);

}  // namespace drogue::app
