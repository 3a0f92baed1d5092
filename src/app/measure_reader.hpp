// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a case file that says what is measured of the flow.
#pragma once

#include "app/case.hpp"
#include "app/section.hpp"

namespace drogue::app {

/// Reads `[measure]` and the files it names. Throws InputError.
Measure read_measure(Section section);

}  // namespace drogue::app
