// SPDX-License-Identifier: GPL-3.0-or-later
// Cases without a fluid: regions, cables and points from a case, what is measured, and what can be wrong about them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "io/csv.hpp"
#include "run_fixture.hpp"

namespace drogue::app {
namespace {

const std::string hanging_sheet = R"(
[fluid]
solver = "none"

[structure]
solver = "relaxation"

[[body]]
name = "load"
mesh = { type = "sheet", corners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], elements = [4, 4] }
density = 1000
thickness = 1e-3
material = { law = "fabric", young_warp = 1e8, young_weft = 1e8, shear = 4e7 }
gravity = [0, 0, -10]

[[body.point]]
name = "hook"
place = [0, 0, 2]

[[body.cable]]
name = "lines"
from = "corners"
to = "hook"
elements = 2
density = 1000
section = 1e-6
young = 1e9

[[body.hold]]
nodes = "hook"
rigid = true

[[body.probe]]
name = "depth"
place = [0, 0, 0]
direction = [0, 0, -1]
over = 2

[time]
end = 1

[output]
canopy = 1
)";

class StructureCase : public RunTest {
 protected:
  StructureCase() {
    write(hanging_sheet);
    options_.until.reset();
  }
  void write(const std::string& text) { folder_.write("case.toml", text); }
};

TEST_F(StructureCase, a_sheet_on_four_cables_hangs_in_equilibrium_and_what_was_asked_for_is_measured) {
  run_case(options_);
  const auto results = summary()["results"];
  EXPECT_TRUE(summary()["finished"]);
  EXPECT_GT(results["depth"].get<double>(), 0.05);
  EXPECT_FALSE(results.contains("cd_stable"));
  const auto told = lines("log.txt");
  EXPECT_TRUE(std::ranges::any_of(told, [](const std::string& line) { return line.find("depth") != line.npos; }));
  EXPECT_TRUE(std::filesystem::exists(options_.folder / "canopy_000001.vtu"));

  const io::CsvTable history = io::read_csv(options_.folder / "history.csv");
  const double weight = 10.0 * 1000.0 * (4.0 * 1e-3 + 4.0 * std::sqrt(6.0) * 1e-6);
  EXPECT_NEAR(history.find("load.reaction_z")->back() / weight, 1.0, 1e-5);
}

TEST_F(StructureCase, solvers_agree_and_the_summary_names_what_was_used) {
  // Hung by its corners the sheet buckles, and may do so in several ways.
  write(replaced(hanging_sheet, "[[body.probe]]", "[[body.hold]]\nnodes = \"rim\"\nrigid = true\n\n[[body.probe]]"));
  options_.force = true;
  std::vector<double> depth;
  for (const std::string solver : {"relaxation", "newton", "equilibrium"}) {
    options_.overrides = {"structure.solver=" + solver};
    run_case(options_);
    const std::string used = summary()["structure"]["load"];
    EXPECT_TRUE(used == solver || solver == "equilibrium") << used;
    depth.push_back(summary()["results"]["depth"]);
  }
  EXPECT_NEAR(depth[1] / depth[0], 1.0, 1e-4);
  EXPECT_NEAR(depth[2] / depth[0], 1.0, 1e-4);
}

TEST_F(StructureCase, a_moving_structure_continues_from_its_checkpoint) {
  const std::string moving = replaced(hanging_sheet, "solver = \"relaxation\"", "step = 0.001");
  write(replaced(moving, "end = 1", "end = 0.02"));
  for (const std::string integrator : {"explicit", "implicit"}) {
    options_.overrides = {"body.load.integrator=" + integrator};
    options_.force = true;
    run_case(options_);
    EXPECT_EQ(summary()["structure"]["load"], integrator);
    const std::vector<std::string> whole = history();
    options_.until = 0.01;
    run_case(options_);
    options_.force = false;
    options_.until.reset();
    options_.resume = true;
    run_case(options_);
    EXPECT_EQ(history(), whole);
    options_.resume = false;
  }
}

TEST_F(StructureCase, motion_that_nothing_resists_is_a_warning) {
  const std::string cable =
      "[[body.cable]]\nname = \"bar\"\nfrom = \"hook\"\nto = \"post\"\nelements = 2\ndensity = 1\n"
      "section = 1e-6\nyoung = 1e9\n\n[[body.point]]\nname = \"post\"\nplace = [0, 0, 3]\n\n"
      "[[body.hold]]\nnodes = \"post\"\nrigid = true\n\n[[body.probe]]";
  write(replaced(replaced(hanging_sheet, "[[body.probe]]", cable), "gravity = [0, 0, -10]", "gravity = [0, 0, 0]"));
  options_.overrides = {"structure.solver=newton"};
  run_case(options_);
  const std::string warning = summary()["warnings"][0];
  EXPECT_NE(warning.find("body load: nothing resists a motion of node"), std::string::npos) << warning;
}

TEST_F(StructureCase, mistakes_are_named_with_their_place) {
  const std::vector<std::array<std::string, 3>> mistakes{
      {"from = \"corners\"", "from = \"corner\"",
       "body.load.cable.lines is wrong: the mesh has no node set \"corner\""},
      {"nodes = \"hook\"", "nodes = \"hooks\"", "body.load.hold.0.nodes is wrong: the mesh has no node set \"hooks\""},
      {"name = \"load\"", "name = \"load\"\npressure = [{ region = \"top\", pressure = 1 }]",
       "body.load is wrong: the mesh has no region \"top\""},
      {"law = \"fabric\"", "law = \"fabrik\"", "did you mean fabric?"},
      {"[time]", "[contact]\ngap = 0.1\n[time]", "contact needs structures that move"},
      {"[time]", "[contact]\ngap = -0.1\n[time]", "contact.gap = -0.1"},
      {"to = \"hook\"", "to = \"corners\"", "body.load.cable.lines is wrong: it joins a node with itself"},
      {"[[body.hold]]\nnodes = \"hook\"\nrigid = true\n", "",
       "body.load is wrong: nothing holds the part of the structure with node 0 at (-1, -1, 0) m along z, and loads"},
      {"name = \"load\"", "name = \"load\"\nintegrator = \"implicitly\"", "did you mean implicit?"},
      {"density = 1000", "density = 0", "body.load.density = 0 is out of range; expected a number above 0"},
  };
  for (const auto& [from, to, message] : mistakes) {
    write(replaced(hanging_sheet, from, to));
    options_.overrides = {"structure.most_iterations=2000"};
    options_.force = true;
    const std::string found = error<std::runtime_error>();
    EXPECT_NE(found.find(message), std::string::npos) << found;
  }
}

}  // namespace
}  // namespace drogue::app
