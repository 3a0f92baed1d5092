// SPDX-License-Identifier: GPL-3.0-or-later
// What a benchmark is asked for.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace drogue::bench {

struct Options {
  std::filesystem::path folder = "runs/bench";  ///< where tables and figures go
  std::vector<std::string> only;                ///< parts of a family by name; all if empty
  bool quick = false;                           ///< seconds instead of minutes: whether it works, not how good it is

  bool wants(const std::string& part) const { return only.empty() || std::ranges::find(only, part) != only.end(); }
};

}  // namespace drogue::bench
