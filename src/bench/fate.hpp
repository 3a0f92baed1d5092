// SPDX-License-Identifier: GPL-3.0-or-later
// What becomes of a run that may fail.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/case.hpp"

namespace drogue::bench {

/// By these names outcomes stand in tables.
namespace outcome {
inline constexpr const char* survived = "survived";    ///< arrived at its end within the bounds
inline constexpr const char* unbounded = "unbounded";  ///< arrived, but left the bounds on the way
inline constexpr const char* diverged = "diverged";    ///< ended with a message that says where and when
inline constexpr const char* left = "left";            ///< ended with a message: a body left the fine grid
inline constexpr const char* refused = "refused";      ///< not begun: the case is no case, with a message
inline constexpr const char* silent = "silent";        ///< arrived with values that are no numbers: a defect
}  // namespace outcome

/// What a flow keeps to if it is computed well, whatever the Reynolds number.
enum class Bound {
  energy,  ///< a closed box: kinetic energy never exceeds that at the start, by more than 1 %
  speed,   ///< an open one: in the second half of the time no speed exceeds three times the inlet's (or the largest
           ///< change of that)
};

/// What is measured is the kinetic energy over that at the start, or the largest speed over that of the inlet.
struct Fate {
  std::string outcome;
  double end = 0.0;                  ///< [s] reached
  double largest = 0.0, last = 0.0;  ///< of what is measured
  std::string message = {};          ///< of a run that ended early
};

/// Reads a case and runs it to its end, on the calling thread and its team; grids are made one at a time. `adjust` may
/// set what the case reader does not allow. A mesh that must be generated goes to `folder`.
Fate follow(const std::filesystem::path& file, const std::vector<std::string>& overrides,
            const std::function<void(app::Case&)>& adjust, Bound bound, const std::filesystem::path& folder);

}  // namespace drogue::bench
