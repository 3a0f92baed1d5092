// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command_line.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "app/case_reader.hpp"
#include "app/inspect.hpp"
#include "case_folder.hpp"
#include "core/error.hpp"

namespace drogue::app {
namespace {

template <class F>
std::string message_of(F command) {
  try {
    command();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string command_error(const std::vector<std::string>& arguments) {
  return message_of([&] { run_command("drogue", arguments); });
}

TEST(Params, lists_every_key_once_with_its_unit_and_default) {
  const std::string list = list_keys("");
  for (const char* fragment : {"[fluid]", "viscosity", "[m^2/s]", "lattice_velocity", "0.05", "[[body.hold]]",
                               "[reference.NAME]", "stiffness", "[N/m^4]", "required"}) {
    EXPECT_NE(list.find(fragment), std::string::npos) << fragment;
  }
  EXPECT_EQ(list.find("[domain.y_max]"), std::string::npos) << "one side stands for all";
}

TEST(Params, filters_by_table_key_and_name) {
  EXPECT_EQ(list_keys("fluid").find("coarsest"), std::string::npos);
  EXPECT_NE(list_keys("fluid").find("hrr_sigma"), std::string::npos);
  EXPECT_NE(list_keys("body").find("young"), std::string::npos) << "tables inside a table";
  EXPECT_EQ(list_keys("fluid.density").find("hrr_sigma"), std::string::npos);
  EXPECT_NE(list_keys("density").find("[[body]]"), std::string::npos) << "in every table that has it";
  EXPECT_NE(list_keys("domain.y_max").find("[domain.y_max]"), std::string::npos);
}

TEST(Params, names_the_nearest_key) {
  EXPECT_EQ(message_of([] { list_keys("viscosty"); }), "no key is called \"viscosty\"; did you mean viscosity?");
  EXPECT_EQ(message_of([] { list_keys("fluid.densty"); }),
            "no key is called \"fluid.densty\"; did you mean fluid.density?");
  EXPECT_EQ(message_of([] { list_keys("qqqqqqqqqq"); }), "no key is called \"qqqqqqqqqq\"");
}

TEST(CommandLine, names_the_nearest_command) {
  EXPECT_EQ(command_error({"rnu"}), "rnu is not a command; did you mean run?");
  EXPECT_EQ(command_error({"chekc", "x"}), "chekc is not a command; did you mean check?");
  EXPECT_EQ(command_error({"zzzzzzzz"}), "zzzzzzzz is not a command");
}

TEST(CommandLine, says_what_is_missing_or_too_much) {
  EXPECT_NE(command_error({"run"}).find("CASE is required"), std::string::npos);
  EXPECT_NE(command_error({}).find("subcommand is required"), std::string::npos);
  EXPECT_NE(command_error({"run", "x", "--thread", "2"}).find("--thread"), std::string::npos);
  for (const char* threads : {"0", "100000"}) {
    EXPECT_EQ(command_error({"run", "x", "--threads", threads}),
              fmt::format("--threads: \"{}\" is no number from 1 to 1024; see drogue --help", threads));
  }
  for (const char* time : {"soon", "-1", "0", "nan", "inf"}) {
    EXPECT_EQ(command_error({"run", "x", "--until", time}),
              fmt::format("--until: \"{}\" is no number above 0; see drogue --help", time));
  }
  EXPECT_EQ(command_error({"run", "/no/such/case"}), "/no/such/case does not exist; expected a case folder");
}

TEST(Check, derives_levels_steps_and_cost) {
  const CaseFolder folder;
  folder.write("case.toml", plate_case);
  const std::string report = check_report(folder.path(), {});
  for (const char* fragment : {"A plate", "level", "0.03125", "Mach 0.0866", "coarse steps",
                               "plate: 60 nodes, 20 elements", "holds corners: 32 nodes", "is in order"}) {
    EXPECT_NE(report.find(fragment), std::string::npos) << fragment << " in\n" << report;
  }
}

struct Misplacement {
  std::string from, to, message;
};

TEST(Check, bodies_must_lie_in_the_finest_cells_of_the_domain) {
  const CaseFolder folder;
  const std::vector<Misplacement> misplacements{
      {"centre = [0, 0, 0]", "centre = [0.9, 0.9, 0]", "body.plate.mesh lies outside the domain: its node at ["},
      {"centre = [0, 0, 0]", "centre = [0.93, 0, 0]", "body.plate.mesh comes within 3 cells of a side of the domain"},
      {"box = [[-0.6, -0.6, -0.6], [0.6, 0.6, 0.6]]", "box = [[0.1, 0.1, 0.1], [0.2, 0.2, 0.2]]",
       "body.plate.mesh does not lie in cells of grid.finest = 0.03125 m with 3 cells around it: its node at ["},
      {"nodes = \"corners\"\npatch = 0.1", "nodes = \"edge\"",
       "body.plate.hold.0.nodes is wrong: the mesh has no node set \"edge\""},
  };
  for (const auto& [from, to, message] : misplacements) {
    folder.write("case.toml", replaced(plate_case, from, to));
    const std::string found = message_of([&] { check_report(folder.path(), {}); });
    EXPECT_NE(found.find(message), std::string::npos) << found;
    EXPECT_TRUE(found.starts_with(folder.path().string() + "/case.toml:")) << found;
  }
}

TEST(Check, geometry_without_gmsh_is_a_clear_error) {
  if (access("/usr/bin/gmsh", X_OK) == 0) GTEST_SKIP() << "gmsh is installed";
  const CaseFolder folder;
  const std::size_t begin = plate_case.find("mesh = "), end = plate_case.find("material");
  std::string text = plate_case;
  folder.write("case.toml", text.replace(begin, end - begin, "mesh = \"plate.geo\"\nreference_area = 1\n"));
  folder.write("plate.geo", "");
  const std::string found = message_of([&] { check_report(folder.path(), {}); });
  EXPECT_NE(found.find("needs gmsh, which is not installed"), std::string::npos) << found;
}

}  // namespace
}  // namespace drogue::app
