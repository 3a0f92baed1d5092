// SPDX-License-Identifier: GPL-3.0-or-later
// What becomes of a run that may fail.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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
  speed,   ///< an open one: no speed beyond three times that of the inlet, after one tenth of the time
};

struct Fate {
  std::string outcome;
  double end = 0.0;          ///< [s] reached
  double measure = 0.0;      ///< largest kinetic energy over that at the start, or largest speed over the inlet's
  std::string message = {};  ///< of a run that ended early
};

/// Reads a case and runs it to its end, on the calling thread and its team; grids are made one at a time. A
/// `lattice_velocity` may exceed what the case reader allows. A mesh that must be generated goes to `folder`.
Fate follow(const std::filesystem::path& file, const std::vector<std::string>& overrides,
            std::optional<double> lattice_velocity, Bound bound, const std::filesystem::path& folder);

}  // namespace drogue::bench
