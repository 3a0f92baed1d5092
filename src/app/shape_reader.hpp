// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the shapes that a case file describes by their dimensions.
#pragma once

#include "app/section.hpp"
#include "geometry/surface.hpp"

namespace drogue::app {

inline const Choices<int> axes{{"x", 0}, {"y", 1}, {"z", 2}};

/// Throws InputError.
geometry::Shape read_shape(Section section);

}  // namespace drogue::app
