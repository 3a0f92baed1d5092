// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plot.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>

#include "synthetic_run.hpp"
#include "temporary_folder.hpp"

namespace drogue {
namespace {

namespace fs = std::filesystem;

bool is_png(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string start{std::istreambuf_iterator<char>(stream), {}};
  return start.size() > 1000 && start.substr(1, 3) == "PNG";
}

io::Figure drag() {
  const double gap = std::numeric_limits<double>::quiet_NaN();
  io::Plot plot{"Drag of Smith's plate", {"time [s]"}, {"C_D"}, {}};
  plot.curves = {{"run", {0.0, 1.0, 2.0}, {1.5, gap, 1.25}}, {io::plain("slip_rms"), {0.0, 2.0}, {1.2, 1.2}}};
  return {"", {plot}};
}

io::MapFigure survival() {
  io::CategoryMap map{"hrr", "lattice velocity", "Reynolds number", {"0.1", "0.2"}, {"10^2", "10^3"}};
  map.cells = {{{0, "a"}, {1, "b"}}, {{1, "c"}, {0, "d"}}};
  map.frame = {1, 0, 1, 2};
  return {"Survival", {{"survived", "#88ccaa"}, {"diverged", "#cc6677"}}, "default", "measured", {map}};
}

TEST(Plot, script_holds_the_data_and_leaves_gaps) {
  const std::string script = io::gnuplot_script(drag(), "drag.png");
  EXPECT_NE(script.find("0 1.5\n\n2 1.25\n"), std::string::npos) << script;
  EXPECT_NE(script.find("'Drag of Smith''s plate'"), std::string::npos) << "a quote in a title ends it";
  EXPECT_NE(script.find("slip\\_rms"), std::string::npos);
}

TEST(Plot, a_map_puts_each_cell_into_its_category) {
  const std::string script = io::gnuplot_script(survival(), "map.png");
  EXPECT_NE(script.find("$cells_0_0 << END\n0 0 \"a\"\n1 1 \"d\"\nEND"), std::string::npos) << script;
  EXPECT_NE(script.find("$cells_0_1 << END\n1 0 \"b\"\n0 1 \"c\"\nEND"), std::string::npos);
  EXPECT_NE(script.find("$frame_0 << END\n0.5 1 0.97 0.47\nEND"), std::string::npos);
}

TEST(Plot, pictures_are_drawn_also_where_there_is_no_data) {
  const test::TemporaryFolder folder("plots");
  if (!io::draw(drag(), folder / "drag.png")) GTEST_SKIP() << io::no_gnuplot;
  EXPECT_TRUE(is_png(folder / "drag.png"));
  EXPECT_TRUE(io::draw(survival(), folder / "map.png"));
  EXPECT_TRUE(is_png(folder / "map.png"));
  const io::Plot empty{"nothing", {"x", io::Scale::logarithmic}, {"y"}, {{"none", {}, {}}}};
  EXPECT_TRUE(io::draw(io::Figure{"Two", {empty, empty}, 2}, folder / "empty.png"));
  EXPECT_TRUE(is_png(folder / "empty.png"));
}

TEST(Plot, without_gnuplot_there_is_no_picture_and_no_error) {
  const test::TemporaryFolder folder("no_gnuplot");
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  const bool drawn = io::draw(drag(), folder / "drag.png");
  setenv("PATH", path.c_str(), 1);
  EXPECT_FALSE(drawn);
  EXPECT_TRUE(fs::is_empty(folder.path())) << "the script is left behind";
}

}  // namespace
}  // namespace drogue
