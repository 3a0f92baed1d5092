// SPDX-License-Identifier: GPL-3.0-or-later
// What of a body meets the fluid: a canopy on cables that leave the finest cells.
#include <gtest/gtest.h>

#include "run_fixture.hpp"

namespace drogue::app {
namespace {

const std::string canopy_on_lines = R"(
[domain]
lower = [-2, -1, -1]
upper = [2, 1, 1]
x_min = { type = "velocity", velocity = [1, 0, 0] }
x_max = { type = "outlet" }
y_min = { type = "free_slip" }
y_max = { type = "free_slip" }
z_min = { type = "free_slip" }
z_max = { type = "free_slip" }

[fluid]
density = 1.2
viscosity = "1/100"
reference_velocity = 1

[grid]
coarsest = "1/16"
finest = "1/32"

[[grid.region]]
box = [[-0.3, -0.5, -0.5], [0.3, 0.5, 0.5]]

[[body]]
name = "canopy"
reference_area = 0.16
mesh = { type = "sheet", corners = [[0, -0.2, -0.2], [0, 0.2, -0.2], [0, 0.2, 0.2], [0, -0.2, 0.2]], elements = [8, 8] }
density = 500
thickness = 1e-4
material = { law = "fabric", young_warp = 1e6, young_weft = 1e6, shear = 4e5 }

[[body.point]]
name = "confluence"
place = [-1.9, 0, 0]

[[body.cable]]
name = "lines"
from = "corners"
to = "confluence"
elements = 20
density = 800
section = 1e-6
young = 1e8
coupled = false

[[body.hold]]
nodes = "confluence"
rigid = true

[time]
end = 0.025
)";

class CoupledParts : public RunTest {
 protected:
  CoupledParts() { write(canopy_on_lines); }
  void write(const std::string& text) { folder_.write("case.toml", text); }
};

TEST_F(CoupledParts, cables_that_are_not_coupled_leave_the_finest_cells_and_hold_the_canopy) {
  run_case(options_);
  const auto results = summary()["results"];
  EXPECT_TRUE(summary()["finished"]);
  EXPECT_GT(results["cd_peak"].get<double>(), 0.0);
}

TEST_F(CoupledParts, what_is_coupled_may_be_massless_and_nothing_else) {
  write(replaced(canopy_on_lines, "density = 500", "density = 0"));
  run_case(options_);
  EXPECT_TRUE(summary()["finished"]);
  write(replaced(canopy_on_lines, "density = 800", "density = 0"));
  const std::string found = error();
  EXPECT_NE(found.find("density = 0 is out of range; expected a number above 0"), std::string::npos) << found;
}

TEST_F(CoupledParts, cables_that_are_coupled_must_lie_in_the_finest_cells) {
  write(replaced(canopy_on_lines, "coupled = false\n", ""));
  const std::string found = error();
  EXPECT_NE(found.find("node of region \"lines\" at ["), std::string::npos) << found;
  EXPECT_NE(found.find("coupled = false"), std::string::npos) << found;
}

TEST_F(CoupledParts, something_must_be_coupled) {
  std::string lines_alone = canopy_on_lines;
  const std::size_t mesh = lines_alone.find("mesh = "), point = lines_alone.find("[[body.point]]");
  lines_alone.replace(mesh, point - mesh, "mesh.type = \"empty\"\n[[body.point]]\nname = \"end\"\nplace = [0, 0, 0]\n");
  write(replaced(lines_alone, "from = \"corners\"", "from = \"end\""));
  const std::string found = error();
  EXPECT_NE(found.find("no region is coupled"), std::string::npos) << found;
}

TEST_F(CoupledParts, without_a_fluid_there_is_nothing_to_couple_with) {
  std::string alone = canopy_on_lines.substr(canopy_on_lines.find("[[body]]"));
  alone = "[fluid]\nsolver = \"none\"\n[structure]\nstep = 1e-3\n" + replaced(alone, "reference_area = 0.16\n", "");
  write(alone);
  EXPECT_NE(error().find("coupled"), std::string::npos);
}

}  // namespace
}  // namespace drogue::app
