// SPDX-License-Identifier: GPL-3.0-or-later
// Colour maps of even lightness steps, and round ends for their ranges.
#pragma once

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

#include <array>

namespace drogue::render {

enum class ColourMap {
  embers,         ///< dark violet to pale yellow
  blues,          ///< white to dark blue
  blues_reversed  ///< dark blue to white
};

using Range = std::array<double, 2>;

vtkSmartPointer<vtkLookupTable> lookup_table(ColourMap map, const Range& range);

/// A range with ends fit for labels that holds both values, zero included; a lower end below a twentieth of the upper
/// is taken as zero.
Range round_range(double lowest, double highest);

}  // namespace drogue::render
