// SPDX-License-Identifier: GPL-3.0-or-later
// The two ways a run may fail. A user's mistake is an InputError (exit code 2), a solution that left
// its bounds is Diverged (exit code 3); a programmer's mistake is an assertion.
#pragma once

#include <stdexcept>
#include <string>

#include "core/types.hpp"

namespace drogue {

/// A user's mistake. The message is one sentence: file, line, key, value and what was expected.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The solution left its physical bounds; the message names what, when and where.
class Diverged : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;

  /// A fluid cell: `time` [s], refinement `level`, `block` id, `cell` inside the block, `position` [m].
  Diverged(const std::string& what, double time, int level, int block, const Index3& cell, const Vec3& position);
};

}  // namespace drogue
