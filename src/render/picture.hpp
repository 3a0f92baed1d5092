// SPDX-License-Identifier: GPL-3.0-or-later
// Draws scenes side by side with common colours and one camera a row, and writes a PNG. VTK 9.1 as Debian builds it
// needs a display to draw: run under xvfb-run.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "render/scene.hpp"
#include "render/view.hpp"

namespace drogue::render {

struct Row {
  Content content;
  View view;
};

struct Picture {
  std::string title;
  std::array<int, 2> size{1600, 900};  ///< [pixels]
  std::vector<Row> rows;               ///< one below the other; every scene is a column of its own
  Quantity field = Quantity::speed;    ///< what colours slice and iso-surface
};

/// Throws InputError without a display, std::runtime_error naming the file if it cannot be written.
void draw(const std::vector<Scene>& scenes, const Picture& picture, const std::filesystem::path& png);

}  // namespace drogue::render
