// SPDX-License-Identifier: GPL-3.0-or-later
// Reads an elastic body of a case file: its mesh, what it is made of, what holds and loads it, and what is measured.
#pragma once

#include "app/case.hpp"
#include "app/section.hpp"

namespace drogue::app {

/// Of `c` the fluid is there already. Throws InputError.
Body read_elastic(Section& section, const Case& c);

}  // namespace drogue::app
