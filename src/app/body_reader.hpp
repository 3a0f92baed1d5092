// SPDX-License-Identifier: GPL-3.0-or-later
// Reads one body of a case file.
#pragma once

#include "app/case.hpp"
#include "app/section.hpp"

namespace drogue::app {

/// An elastic body has a `mesh`, a rigid one a `shape` or a `surface`. Of `c` the fluid and the grid are there already.
/// Throws InputError.
Body read_body(Section& section, const Case& c);

}  // namespace drogue::app
