// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/colours.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace drogue::render {
namespace {

using Colour = std::array<double, 3>;

// From dark violet over red to pale yellow; after matplotlib's inferno without its black end.
constexpr std::array<Colour, 9> embers{{{0.258, 0.039, 0.406},
                                        {0.397, 0.083, 0.433},
                                        {0.533, 0.134, 0.415},
                                        {0.667, 0.182, 0.370},
                                        {0.796, 0.245, 0.296},
                                        {0.902, 0.349, 0.196},
                                        {0.970, 0.490, 0.080},
                                        {0.987, 0.663, 0.072},
                                        {0.965, 0.870, 0.320}}};
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

// The next number that reads well, as do its quarters.
double round_up(double value) {
  if (value <= 0.0) return 0.0;
  constexpr std::array<double, 14> steps{1.0, 1.2, 1.6, 2.0, 2.4, 2.8, 3.2, 3.6, 4.0, 4.8, 5.0, 6.0, 8.0, 10.0};
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  return *std::find_if(steps.begin(), steps.end() - 1, [&](double s) { return s * power >= 0.999 * value; }) * power;
}

}  // namespace

vtkSmartPointer<vtkLookupTable> lookup_table(ColourMap map, const Range& range) {
  constexpr int entries = 256;
  std::vector<Colour> colours(map == ColourMap::embers ? embers.begin() : blues.begin(),
                              map == ColourMap::embers ? embers.end() : blues.end());
  if (map == ColourMap::blues_reversed) std::reverse(colours.begin(), colours.end());
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
  const Range range{-lowest < 0.05 * highest ? 0.0 : -round_up(-lowest), round_up(highest)};
  return range[1] > range[0] ? range : Range{0.0, 1.0};
}

}  // namespace drogue::render
