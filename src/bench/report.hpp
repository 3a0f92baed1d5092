// SPDX-License-Identifier: GPL-3.0-or-later
// What a family of benchmarks hands back: its text in Markdown, and whether its figures could be drawn.
#pragma once

#include <filesystem>
#include <string>

#include "io/plot.hpp"

namespace drogue::bench {

struct Report {
  std::string text;
  bool drawn = true;  ///< all figures so far

  template <class Figure>
  void draw(const Figure& figure, const std::filesystem::path& png) {
    drawn = io::draw(figure, png) && drawn;
  }
};

/// Where the sources lie, and with them the cases that are run.
std::filesystem::path repository();

}  // namespace drogue::bench
