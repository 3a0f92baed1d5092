// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/colours.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace drogue::render {
namespace {

using Colour = std::array<double, 3>;

// van der Walt & Smith, matplotlib 2015.
constexpr std::array<Colour, 9> viridis{{{0.267, 0.005, 0.329},
                                         {0.279, 0.175, 0.483},
                                         {0.230, 0.322, 0.546},
                                         {0.173, 0.449, 0.558},
                                         {0.128, 0.567, 0.551},
                                         {0.158, 0.684, 0.502},
                                         {0.369, 0.789, 0.383},
                                         {0.678, 0.864, 0.190},
                                         {0.993, 0.906, 0.144}}};
// ColorBrewer Blues, Harrower & Brewer, The Cartographic Journal 40 (2003) 27.
constexpr std::array<Colour, 9> blues{{{0.969, 0.984, 1.000},
                                       {0.871, 0.922, 0.969},
                                       {0.776, 0.859, 0.937},
                                       {0.620, 0.792, 0.882},
                                       {0.420, 0.682, 0.839},
                                       {0.259, 0.573, 0.776},
                                       {0.129, 0.443, 0.710},
                                       {0.031, 0.318, 0.612},
                                       {0.031, 0.188, 0.420}}};

std::span<const Colour> stops(ColourMap map) {
  return map == ColourMap::viridis ? std::span(viridis) : std::span(blues);
}

double round_up(double value) {
  if (value <= 0.0) return 0.0;
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::ceil(value / step - 1e-6) * step;
}

}  // namespace

vtkSmartPointer<vtkLookupTable> lookup_table(ColourMap map, const Range& range) {
  constexpr int entries = 256;
  const auto colours = stops(map);
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(entries);
  table->SetRange(range[0], range[1]);
  for (int i = 0; i < entries; ++i) {
    const double place = static_cast<double>(i) / (entries - 1) * static_cast<double>(colours.size() - 1);
    const auto stop = std::min(static_cast<std::size_t>(place), colours.size() - 2);
    const double t = place - static_cast<double>(stop);
    Colour c;
    for (std::size_t a = 0; a < 3; ++a) c[a] = (1.0 - t) * colours[stop][a] + t * colours[stop + 1][a];
    table->SetTableValue(i, c[0], c[1], c[2]);
  }
  return table;
}

Range round_range(double lowest, double highest) {
  const Range range{-round_up(-lowest), round_up(highest)};
  return range[1] > range[0] ? range : Range{0.0, 1.0};
}

}  // namespace drogue::render
