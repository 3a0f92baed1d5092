// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of curves and of maps, drawn by gnuplot. Texts are gnuplot's enhanced ones: "C_D" has a subscript,
// "10^{-3}" an exponent; `plain` protects names that are meant literally.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drogue::io {

enum class Scale { linear, logarithmic, whole };  ///< whole: linear, with a tick at every whole number

struct Axis {
  std::string label;  ///< with the unit: "time [s]"
  Scale scale = Scale::linear;
  std::optional<double> lower = {}, upper = {};  ///< from the data if not given
};

enum class Style { line, dashed, points, line_and_points, ring };  ///< ring: around a point that others draw

struct Curve {
  std::string label;                   ///< without one it is not in the legend
  std::vector<double> x = {}, y = {};  ///< a value that is not finite is a gap
  Style style = Style::line;
  std::optional<int> mark = {};    ///< which symbol its points have; if not given, that of its place in the plot
  std::optional<int> colour = {};  ///< of the palette; if not given, that of its place in the plot
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Curve> curves = {};
};

/// Plots side by side, `columns` in a row.
struct Figure {
  std::string title;
  std::vector<Plot> plots;
  int columns = 1;
};

/// One kind of cell of a map.
struct Category {
  std::string label;
  std::string colour;  ///< "#rrggbb"
};

/// A table whose cells are coloured by category. Rows count upwards.
struct CategoryMap {
  struct Cell {
    int category = 0;
    std::string text;
  };
  /// A rectangle of cells to point out.
  struct Frame {
    int row = 0, column = 0, rows = 1, columns = 1;
  };
  std::string title;
  std::string x_label, y_label;
  std::vector<std::string> columns, rows;     ///< labels of the cells along x and y
  std::vector<std::vector<Cell>> cells = {};  ///< [row][column]
  std::optional<Frame> frame = {};
};

struct MapFigure {
  std::string title;
  std::vector<Category> categories;  ///< those that no cell has are not in the legend
  std::string frame_label;           ///< what the framed cells are
  std::string note;                  ///< what the texts of the cells mean, one line below all
  std::vector<CategoryMap> maps;
  int columns = 1;
};

/// The text with nothing in it that gnuplot would take for a command: "slip_rms" keeps its underscore.
std::string plain(const std::string& text);

/// What makes gnuplot draw the figure into the file.
std::string gnuplot_script(const Figure& figure, const std::filesystem::path& png);
std::string gnuplot_script(const MapFigure& figure, const std::filesystem::path& png);

/// Draws a picture; false if gnuplot is not installed. Throws std::runtime_error with what gnuplot said if it fails.
bool draw(const Figure& figure, const std::filesystem::path& png);
bool draw(const MapFigure& figure, const std::filesystem::path& png);

/// What to tell a user whose pictures were not drawn.
inline constexpr const char* no_gnuplot =
    "gnuplot is not installed, so no pictures were drawn; on Debian: apt-get install gnuplot-nox, then run this again";

}  // namespace drogue::io
