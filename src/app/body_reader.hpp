// SPDX-License-Identifier: GPL-3.0-or-later
// Reads one body of a case file.
#pragma once

#include "app/case.hpp"
#include "app/section.hpp"

namespace drogue::app {

/// An elastic body has a `mesh`, a rigid one a `shape` or a `surface`. Throws InputError.
Body read_body(Section& section, double fluid_density);

}  // namespace drogue::app
