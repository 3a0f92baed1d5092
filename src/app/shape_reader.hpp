// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the shapes that a case file describes by their dimensions.
#pragma once

#include "app/section.hpp"
#include "geometry/surface.hpp"

namespace drogue::app {

/// Throws InputError.
geometry::Shape read_shape(Section section);

}  // namespace drogue::app
