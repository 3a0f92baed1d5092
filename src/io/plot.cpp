// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "core/error.hpp"
#include "core/process.hpp"

namespace drogue::io {

namespace {

namespace fs = std::filesystem;

// Distinct also in print and to the colour-blind, after P. Tol, "Colour schemes" (2021), "bright" darkened for lines.
constexpr std::array palette{"#2f5d8a", "#c8493a", "#3f8f4f", "#d99a1c", "#7d4a9c", "#3aa0b0", "#8c6d4f", "#6b6b6b"};
constexpr int panel_width = 900, panel_height = 620, heading = 40, map_footer = 90;  // pixels

/// A string of a script.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

/// Panels in rows under a heading and over a footer, in pixels.
struct Layout {
  int columns, rows, footer;

  Layout(std::size_t panels, int wanted_columns, int below = 0)
      : columns(std::max(1, std::min(wanted_columns, static_cast<int>(panels)))),
        rows((static_cast<int>(panels) + columns - 1) / columns),
        footer(below) {}
  int width() const { return columns * panel_width; }
  int height() const { return heading + rows * panel_height + footer; }
};

/// Terminal and file.
std::string opening(const fs::path& png, const Layout& layout) {
  return fmt::format(
      "set encoding utf8\n"
      "set terminal pngcairo enhanced size {},{} font 'DejaVu Sans,13' background '#ffffff'\n"
      "set output {}\n"
      "set border 3 linecolor '#444444'\nset tics nomirror textcolor '#222222'\n"
      "set grid linecolor '#dddddd' linetype 1 linewidth 1\n"
      "set title font ',14'\n",
      layout.width(), layout.height(), quoted(png.string()));
}

/// The grid of panels; `margins` of the panels if they are fixed.
std::string multiplot(const Layout& layout, const std::string& title, const std::string& margins = "") {
  const std::string text = fmt::format("set multiplot layout {},{} {}", layout.rows, layout.columns, margins);
  return text + (title.empty() ? "\n" : fmt::format(" title {} font ',17'\n", quoted(title)));
}

/// Fixed margins of maps, whose one legend stands in the footer.
std::string map_margins(const Layout& layout) {
  const double w = layout.width(), h = layout.height();
  return fmt::format("margins screen {:.4f},{:.4f},{:.4f},{:.4f} spacing screen {:.4f},{:.4f}", 110 / w, 1 - 30 / w,
                     (layout.footer + 70) / h, 1 - (heading + 50) / h, 110 / w, 130 / h);
}

/// Ticks of a logarithmic axis are powers of ten where it spans several of them.
std::string axis(char name, const Axis& axis, std::array<double, 2> span) {
  const auto limit = [](std::optional<double> value) { return value ? fmt::format("{:.9g}", *value) : "*"; };
  std::string text = fmt::format("set {0}label {1}\nset {0}range [{2}:{3}]\n", name, quoted(axis.label),
                                 limit(axis.lower), limit(axis.upper));
  text += fmt::format("set {}tics {}\n", name, axis.scale == Scale::whole ? "1" : "autofreq");
  if (axis.scale != Scale::logarithmic) {
    text += fmt::format("unset logscale {0}\nset format {0} '%g'\n", name);
  } else {
    const bool decades = span[1] >= 30.0 * span[0];
    text += fmt::format("set logscale {0}\nset format {0} '{1}'\n", name, decades ? "10^{{%L}}" : "%g");
  }
  return text;
}

/// Smallest and largest finite value of a coordinate; positive ones only on a logarithmic axis.
std::array<double, 2> span_of(const Plot& plot, const Axis& axis, std::vector<double> Curve::*coordinate) {
  std::array span{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
  for (const Curve& curve : plot.curves) {
    for (const double value : curve.*coordinate) {
      if (!std::isfinite(value) || (axis.scale == Scale::logarithmic && value <= 0.0)) continue;
      span = {std::min(span[0], value), std::max(span[1], value)};
    }
  }
  return {axis.lower.value_or(span[0]), axis.upper.value_or(span[1])};
}

std::string data_block(const std::string& name, const Curve& curve) {
  std::string text = fmt::format("${} << END\n", name);
  for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i) {
    // a blank line is a gap
    const bool finite = std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]);
    text += finite ? fmt::format("{:.9g} {:.9g}\n", curve.x[i], curve.y[i]) : "\n";
  }
  return text + "END\n";
}

std::string with_style(const Curve& curve, int place) {
  const int colour = curve.colour.value_or(place);
  const auto line = fmt::format("linecolor rgb '{}' linewidth 2", palette[colour % palette.size()]);
  const auto marks =
      fmt::format("pointtype {} pointsize 1.3", std::array{7, 5, 9, 11, 13, 15}[curve.mark.value_or(place) % 6]);
  switch (curve.style) {
    case Style::line:
      return "lines " + line;
    case Style::dashed:
      return "lines dashtype 2 " + line;
    case Style::points:
      return "points " + line + " " + marks;
    case Style::line_and_points:
      return "linespoints " + line + " " + marks;
    case Style::ring:
      return fmt::format("points linecolor rgb '{}' linewidth 2 pointtype 6 pointsize 3",
                         palette[colour % palette.size()]);
  }
  return {};
}

std::string panel(const Plot& plot, int number) {
  std::string text = fmt::format("set title {}\n", quoted(plot.title));
  const auto x = span_of(plot, plot.x, &Curve::x), y = span_of(plot, plot.y, &Curve::y);
  text += axis('x', plot.x, x) + axis('y', plot.y, y);
  // below the plot, where it covers no data
  text += "set key bmargin center horizontal Left reverse samplen 2 height 1.2 width 2 textcolor '#222222'\n";
  if (x[0] > x[1] || y[0] > y[1]) {
    return text +
           "unset logscale\nset label 1 'no data' at graph 0.5,0.5 center\nplot [0:1] [0:1] -1 notitle\n"
           "unset label 1\n";
  }
  std::vector<std::string> drawn;
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    const Curve& curve = plot.curves[i];
    const auto name = fmt::format("curve_{}_{}", number, i);
    text += data_block(name, curve);
    const auto title = curve.label.empty() ? "notitle" : "title " + quoted(curve.label);
    drawn.push_back(fmt::format("${} with {} {}", name, with_style(curve, static_cast<int>(i)), title));
  }
  return text + fmt::format("plot {}\n", fmt::join(drawn, ", \\\n     "));
}

std::string ticks(char axis, const std::vector<std::string>& labels) {
  std::vector<std::string> places;
  for (std::size_t i = 0; i < labels.size(); ++i) places.push_back(fmt::format("{} {}", quoted(labels[i]), i));
  return fmt::format("set {0}tics scale 0 ({1})\nset {0}range [-0.5:{2}]\n", axis, fmt::join(places, ", "),
                     static_cast<double>(labels.size()) - 0.5);
}

/// Column, row and text of the cells of a category; empty if there are none.
std::string cells_of(const CategoryMap& map, int category) {
  std::string text;
  for (std::size_t row = 0; row < map.cells.size(); ++row) {
    for (std::size_t column = 0; column < map.cells[row].size(); ++column) {
      const auto& cell = map.cells[row][column];
      if (cell.category == category) text += fmt::format("{} {} \"{}\"\n", column, row, cell.text);
    }
  }
  return text;
}

constexpr const char* frame_style = "boxxyerror fill empty border rgb '#111111' linecolor rgb '#111111' linewidth 3";

std::string fill_style(const Category& category) {
  return fmt::format("fill solid noborder linecolor rgb '{}'", category.colour);
}

std::vector<std::string> legend(const MapFigure& figure) {
  std::vector<std::string> entries;
  for (int c = 0; c < static_cast<int>(figure.categories.size()); ++c) {
    if (std::ranges::all_of(figure.maps, [&](const CategoryMap& map) { return cells_of(map, c).empty(); })) continue;
    const Category& category = figure.categories[c];
    entries.push_back(fmt::format("keyentry with boxes {} title {}", fill_style(category), quoted(category.label)));
  }
  if (!figure.frame_label.empty()) {
    entries.push_back(fmt::format("keyentry with {} title {}", frame_style, quoted(figure.frame_label)));
  }
  return entries;
}

std::string panel(const CategoryMap& map, const MapFigure& figure, int number) {
  std::string text = fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n", quoted(map.title), quoted(map.x_label),
                                 quoted(map.y_label));
  text += ticks('x', map.columns) + ticks('y', map.rows);
  std::vector<std::string> drawn;
  for (int c = 0; c < static_cast<int>(figure.categories.size()); ++c) {
    const std::string cells = cells_of(map, c);
    if (cells.empty()) continue;
    const auto name = fmt::format("cells_{}_{}", number, c);
    text += fmt::format("${} << END\n{}END\n", name, cells);
    drawn.push_back(
        fmt::format("${} using 1:2:(0.47):(0.47) with boxxyerror {} notitle", name, fill_style(figure.categories[c])));
    drawn.push_back(fmt::format("${} using 1:2:3 with labels font ',11' textcolor '#222222' notitle", name));
  }
  if (map.frame) {
    const auto& f = *map.frame;
    text += fmt::format("$frame_{} << END\n{} {} {} {}\nEND\n", number, f.column + 0.5 * (f.columns - 1),
                        f.row + 0.5 * (f.rows - 1), 0.5 * f.columns - 0.03, 0.5 * f.rows - 0.03);
    drawn.push_back(fmt::format("$frame_{} with {} notitle", number, frame_style));
  }
  if (number == 0) std::ranges::copy(legend(figure), std::back_inserter(drawn));
  if (drawn.empty()) drawn.emplace_back("-9 notitle");  // an empty map is still a map
  return text + fmt::format("plot {}\n", fmt::join(drawn, ", \\\n     "));
}

bool draw_script(const std::string& script, const fs::path& png) {
  const fs::path file = png.string() + ".gnuplot", log = png.string() + ".log";
  if (std::ofstream stream(file); !(stream << script << std::flush)) {
    throw InputError(fmt::format("{} cannot be written", png.string()));
  }
  const int status = run_program({"gnuplot", file.string()}, log);
  std::ifstream said(log);
  const std::string message{std::istreambuf_iterator<char>(said), {}};
  if (status != 0 && status != not_installed) {
    throw std::runtime_error(
        fmt::format("gnuplot could not draw {} from {}: {}", png.string(), file.string(), message));
  }
  fs::remove(file);
  fs::remove(log);
  return status == 0;
}

}  // namespace

std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::string("_^{}@&~\\").find(c) != std::string::npos) result += '\\';
    result += c;
  }
  return result;
}

std::string gnuplot_script(const Figure& figure, const fs::path& png) {
  const Layout layout(figure.plots.size(), figure.columns);
  std::string text = opening(png, layout) + multiplot(layout, figure.title);
  int number = 0;
  for (const Plot& plot : figure.plots) text += panel(plot, number++);
  return text + "unset multiplot\n";
}

std::string gnuplot_script(const MapFigure& figure, const fs::path& png) {
  const Layout layout(figure.maps.size(), figure.columns, map_footer);
  const double pixel = 1.0 / layout.height();
  std::string text = opening(png, layout);
  text += fmt::format("unset grid\nset label 1 {} at screen 0.5,{:.4f} center textcolor '#222222'\n",
                      quoted(figure.note), 20 * pixel);
  text +=
      fmt::format("set key at screen 0.5,{:.4f} center horizontal Left reverse samplen 1 width 2 textcolor '#222222'\n",
                  65 * pixel);
  text += multiplot(layout, figure.title, map_margins(layout));
  int number = 0;
  for (const CategoryMap& map : figure.maps) {
    text += panel(map, figure, number++);
    text += "unset label 1\n";  // once is enough
  }
  return text + "unset multiplot\n";
}

bool draw(const Figure& figure, const fs::path& png) { return draw_script(gnuplot_script(figure, png), png); }
bool draw(const MapFigure& figure, const fs::path& png) { return draw_script(gnuplot_script(figure, png), png); }

}  // namespace drogue::io
