// SPDX-License-Identifier: GPL-3.0-or-later
// Colour maps of even lightness steps, and round ends for their ranges.
#pragma once

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

#include <array>

namespace drogue::render {

enum class ColourMap { embers, blues };

using Range = std::array<double, 2>;

vtkSmartPointer<vtkLookupTable> lookup_table(ColourMap map, const Range& range);

/// The smallest range with ends of two digits that holds both values, zero included.
Range round_range(double lowest, double highest);

}  // namespace drogue::render
