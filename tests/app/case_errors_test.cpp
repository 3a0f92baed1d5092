// SPDX-License-Identifier: GPL-3.0-or-later
// Every mistake a case file can hold gives one sentence with place, key, value and what was expected.
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "app/case_reader.hpp"
#include "case_folder.hpp"
#include "core/error.hpp"

namespace drogue::app {
namespace {

struct Mistake {
  std::string from, to;  ///< what is changed in the valid case
  std::string message;   ///< after the name of the folder
};

std::string message_of(const std::filesystem::path& path, const std::vector<std::string>& overrides = {}) {
  try {
    read_case(path, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

void expect_messages(const std::vector<Mistake>& mistakes) {
  const CaseFolder folder;
  const std::string prefix = folder.path().string() + "/";
  for (const Mistake& mistake : mistakes) {
    folder.write("case.toml", replaced(plate_case, mistake.from, mistake.to));
    const std::string message = message_of(folder.path());
    const bool starts = message.starts_with(prefix + mistake.message);
    EXPECT_TRUE(starts) << "message:  " << message << "\nexpected: " << prefix << mistake.message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << "one line: " << message;
  }
}

TEST(CaseErrors, unknown_keys_are_named_with_what_was_meant) {
  expect_messages({
      {"viscosity", "viscocity", "case.toml:15: fluid.viscocity is not a known key; did you mean fluid.viscosity?"},
      {"[grid]", "[gird]", "case.toml:18: gird is not a known key; did you mean grid?"},
      {"title", "density", "case.toml:1: density is not a known key; did you mean fluid.density?"},
      {"poisson = 0.3", "poison = 0.3",
       "case.toml:29: body.plate.material.poison is not a known key; did you mean body.plate.material.poisson?"},
      {"x_max =", "x_mx =", "case.toml:7: domain.x_mx is not a known key; did you mean domain.x_max?"},
      {"stiffness", "stifness",
       "case.toml:34: body.plate.hold.0.stifness is not a known key; did you mean "
       "body.plate.hold.0.stiffness?"},
      {"end = 2", "end = 2\nqqqqqqqq = 1", "case.toml:38: time.qqqqqqqq is not a known key"},
      {"value = 1.18", "valeu = 1.18",
       "case.toml:40: reference.cd_stable.valeu is not a known key; did you mean reference.cd_stable.value?"},
  });
}

TEST(CaseErrors, wrong_types_are_named_with_what_was_expected) {
  expect_messages({
      {"density = 1.2", "density = true",
       "case.toml:14: fluid.density = true is a boolean; expected a number above 0 [kg/m^3]"},
      {"density = 1.2", "density = [1]", "case.toml:14: fluid.density = [1] is an array; expected a number"},
      {"title = \"A plate\"", "title = 3", "case.toml:1: title = 3 is an integer; expected a string"},
      {"lower = [-1, -1, -1]", "lower = [-1, -1]",
       "case.toml:4: domain.lower = [-1, -1] has 2 elements; expected three numbers [m]"},
      {"lower = [-1, -1, -1]", "lower = [-1, true, -1]",
       "case.toml:4: domain.lower = [-1, true, -1]: true is a boolean; expected three numbers [m]"},
      {"elements = [4, 5, 1]", "elements = [4, 5.5, 1]",
       "case.toml:28: body.plate.mesh.elements = [4, 5.5, 1]: 5.5 is not whole; expected three integers"},
      {"density = 1.2", "density = {x = 1}", "case.toml:14: fluid.density = {...} is a table"},
      {"y_min = { type = \"free_slip\" }", "y_min = \"free_slip\"",
       "case.toml:8: domain.y_min = \"free_slip\" is a string; expected a table"},
      {"[[body]]", "[body]", "case.toml:25: body is a table; expected [[body]], an array of tables"},
      {"cd_stable = {", "cd_stable = 1.18 # {",
       "case.toml:40: reference.cd_stable = 1.18 is a number; expected a table"},
      {"stiffness = 1e6", "rigid = 1",
       "case.toml:34: body.plate.hold.0.rigid = 1 is an integer; expected true or false"},
      {"box = [[-0.6, -0.6, -0.6], [0.6, 0.6, 0.6]]", "box = [1, 2, 3]",
       "case.toml:23: grid.region.0.box = [1, 2, 3] has 3 elements; expected two corners"},
  });
}

TEST(CaseErrors, missing_keys_are_named_with_their_meaning) {
  expect_messages({
      {"density = 1.2\n", "",
       "case.toml:13: fluid.density is missing; expected a number above 0 [kg/m^3]: mass density"},
      {"viscosity = \"1/100\"\n", "",
       "case.toml:13: fluid.viscosity is missing; expected a number above 0 [m^2/s]: "
       "kinematic; or give fluid.reynolds"},
      {"viscosity = \"1/100\"", "reynolds = 100", "case.toml:13: fluid.reference_length is missing"},
      {"y_max = { type = \"free_slip\" }\n", "", "case.toml: domain.y_max.type is missing; expected \"velocity\", "},
      {"[time]\nend = 2\n", "", "case.toml: time.end is missing; expected a number above 0 [s]: the run starts at 0"},
      {", velocity = [1, 0, 0]", "", "case.toml:6: domain.x_min.velocity is missing"},
      {"name = \"plate\"\n", "", "case.toml:25: body.0.name is missing"},
      {"stiffness = 1e6\n", "", "case.toml:31: body.plate.hold.0.stiffness is missing"},
      {"value = 1.18, ", "", "case.toml:40: reference.cd_stable.value is missing"},
  });
}

TEST(CaseErrors, values_out_of_range_are_named_with_their_bounds) {
  expect_messages({
      {"\"1/100\"", "-1e-3",
       "case.toml:15: fluid.viscosity = -0.001 is out of range; expected a number above 0 [m^2/s]"},
      {"density = 1.2", "density = 0", "case.toml:14: fluid.density = 0 is out of range; expected a number above 0"},
      {"density = 1.2", "density = inf", "case.toml:14: fluid.density = inf is not finite"},
      {"density = 1\n", "density = -1\n",
       "case.toml:27: body.plate.density = -1 is out of range; expected a number of at least 0"},
      {"poisson = 0.3", "poisson = 0.5",
       "case.toml:29: body.plate.material.poisson = 0.5 is out of range; expected a "
       "number between -1 and 0.5"},
      {"[4, 5, 1]", "[4, 0, 1]", "case.toml:28: body.plate.mesh.elements = [4, 0, 1] is out of range"},
      {"thickness = 0.01", "thickness = 0", "case.toml:28: body.plate.mesh.thickness = 0 is out of range"},
      {"end = 2", "end = -2", "case.toml:37: time.end = -2 is out of range; expected a number above 0 [s]"},
      {"end = 2", "end = 2\n[output]\nfluid = -1", "case.toml:39: output.fluid = -1 is out of range"},
      {"patch = 0.1", "patch = -0.1", "case.toml:33: body.plate.hold.0.patch = -0.1 is out of range"},
      {"type = \"outlet\"", "type = \"outlet\", sponge = -1", "case.toml:7: domain.x_max.sponge = -1 is out of range"},
  });
}

TEST(CaseErrors, words_that_are_not_known_are_named_with_the_list) {
  expect_messages({
      {"type = \"outlet\"", "type = \"oulet\"",
       "case.toml:7: domain.x_max.type = \"oulet\" is not known; expected \"velocity\", \"outlet\", \"free_slip\", "
       "\"no_slip\" or \"periodic\"; did you mean outlet?"},
      {"neo_hookean", "steel",
       "case.toml:29: body.plate.material.law = \"steel\" is not known; expected \"neo_hookean\", "
       "\"saint_venant_kirchhoff\", \"fabric\" or \"cable\""},
      {"normal = \"x\"", "normal = \"w\"", "case.toml:28: body.plate.mesh.normal = \"w\" is not known"},
      {"type = \"plate\"", "type = \"disc\"", "case.toml:28: body.plate.mesh.type = \"disc\" is not known"},
  });
}

TEST(CaseErrors, formulas_say_what_was_not_understood) {
  expect_messages({
      {"\"1/100\"", "\"1/1oo\"",
       "case.toml:15: fluid.viscosity = \"1/1oo\" has an unknown name \"oo\" at position 4; "
       "expected a number above 0 [m^2/s]"},
      {"\"1/100\"", "\"x/100\"", "case.toml:15: fluid.viscosity = \"x/100\" is not constant; expected a number"},
      {"velocity = [1, 0, 0]", "velocity = [\"speed*t\", 0, 0]",
       "case.toml:6: domain.x_min.velocity = [\"speed*t\", 0, 0]: \"speed*t\" has an unknown name \"speed\" at "
       "position "
       "1; expected three numbers or formulas in x, y, z, t [m/s]"},
  });
}

TEST(CaseErrors, files_that_cannot_be_read_are_named) {
  const CaseFolder folder;
  const std::string path = folder.path().string();
  EXPECT_EQ(message_of(folder.path()), path + " holds no case.toml");
  EXPECT_EQ(message_of(folder.path() / "nowhere"), path + "/nowhere does not exist; expected a case folder");

  folder.write("case.toml", "[fluid\ndensity = 1\n");
  EXPECT_TRUE(message_of(folder.path()).starts_with(path + "/case.toml:1: not valid TOML: "))
      << message_of(folder.path());
  folder.write("case.toml", "base = \"elsewhere\"\n");
  EXPECT_EQ(message_of(folder.path()), path + "/case.toml:1: base = \"elsewhere\" does not exist");
  folder.write("case.toml", "base = 3\n");
  EXPECT_EQ(message_of(folder.path()), path + "/case.toml:1: base = 3 is an integer; expected the name of a case file");
  folder.write("case.toml", "base = \"case.toml\"\n");
  EXPECT_EQ(message_of(folder.path()), path + "/case.toml: base files refer to each other in a circle");
}

TEST(CaseErrors, mesh_files_must_exist_and_be_meshes) {
  const CaseFolder folder;
  const std::string path = folder.path().string();
  const std::string plate =
      plate_case.substr(plate_case.find("mesh = "), plate_case.find("material") - plate_case.find("mesh = "));
  folder.write("case.toml", replaced(plate_case, plate, "mesh = \"plate.msh\"\n"));
  EXPECT_EQ(message_of(folder.path()),
            path + "/case.toml:28: body.plate.mesh = \"" + path + "/plate.msh\" does not exist");
  folder.write("plate.txt", "");
  folder.write("case.toml", replaced(plate_case, plate, "mesh = \"plate.txt\"\n"));
  EXPECT_EQ(message_of(folder.path()), path + "/case.toml:28: body.plate.mesh = \"" + path +
                                           "/plate.txt\" is no mesh; expected a file .msh or .geo");
  folder.write("plate.msh", "");
  folder.write("case.toml", replaced(plate_case, plate, "mesh = \"plate.msh\"\n"));
  EXPECT_TRUE(message_of(folder.path()).starts_with(path + "/case.toml:25: body.plate.reference_area is missing"))
      << message_of(folder.path());
}

TEST(CaseErrors, keys_without_effect_are_refused) {
  expect_messages({
      {"law = \"neo_hookean\", young", "law = \"saint_venant_kirchhoff\", poisson_stabilisation = 0.4, young",
       "case.toml:29: body.plate.material.poisson_stabilisation has no effect here (ratio behind the bulk modulus"},
      {"y_max = { type = \"free_slip\" }", "y_max = { type = \"free_slip\", pressure = 1 }",
       "case.toml:9: domain.y_max.pressure has no effect here"},
      {"nodes = \"corners\"", "nodes = \"all\"", "case.toml:33: body.plate.hold.0.patch has no effect here"},
      {"stiffness = 1e6", "stiffness = 1e6\nrigid = true", "case.toml:34: body.plate.hold.0.stiffness has no effect"},
      {"[[grid.region]]\n", "[[grid.region]]\nbody = \"plate\"\n",
       "case.toml:23: grid.region.0.body has no effect here"},
      {"end = 2", "end = 2\n[fluid.initial]",
       "case.toml:38: fluid.initial = {...} is a table; expected \"uniform\" or"},
  });
}

TEST(CaseErrors, overrides_are_named_as_such) {
  const CaseFolder folder;
  folder.write("case.toml", plate_case);
  const std::vector<std::pair<std::string, std::string>> mistakes{
      {"fluid.viscocity=1",
       "--set fluid.viscocity=1: fluid.viscocity is not a known key; did you mean fluid.viscosity?"},
      {"fluid.density=-1",
       "--set fluid.density=-1: fluid.density = -1 is out of range; expected a number above 0 [kg/m^3]"},
      {"fluid.density", "--set fluid.density: expected key=value"},
      {"=3", "--set =3: expected key=value"},
      {"fluid..density=3", "--set fluid..density=3: expected key=value"},
      {"reference.cd_stabel.value=1", "--set reference.cd_stabel.value=1: reference.cd_stabel is not the name"},
      {"fluid.density.x=1", "--set fluid.density.x=1: fluid.density is a number and has no key \"x\""},
      {"body.3.density=1", "--set body.3.density=1: body has no element \"3\""},
      {"body.sail.density=1", "--set body.sail.density=1: body has no element \"sail\""},
      {"fluid.density=heavy", "--set fluid.density=heavy: fluid.density = \"heavy\" has an unknown name \"heavy\""},
      {"grid.finest=0.01", "--set grid.finest=0.01: grid.finest = 0.01 is not grid.coarsest / 2^n"},
  };
  for (const auto& [assignment, expected] : mistakes) {
    const std::string message = message_of(folder.path(), {assignment});
    EXPECT_TRUE(message.starts_with(expected)) << "message:  " << message << "\nexpected: " << expected;
  }
}

TEST(CaseErrors, values_must_fit_each_other) {
  expect_messages({
      {"upper = [1, 1, 1]", "upper = [1, -1, 1]",
       "case.toml:5: domain.upper = [1, -1, 1] is not beyond domain.lower = "
       "[-1, -1, -1] in y"},
      {"upper = [1, 1, 1]", "upper = [1, 1, 1.5]",
       "case.toml:19: grid.coarsest = 0.0625 does not divide the domain into "
       "blocks: its edge in z, 2.5 m, must be a multiple of 16 cells, 1 m"},
      {"z_max = { type = \"periodic\" }", "z_max = { type = \"no_slip\" }",
       "case.toml:11: domain.z_max.type is not \"periodic\" although domain.z_min is"},
      {"z_min = { type = \"periodic\" }", "z_min = { type = \"no_slip\" }",
       "case.toml:10: domain.z_min.type is not \"periodic\" although domain.z_max is"},
      {"finest = \"1/32\"", "finest = 0.02",
       "case.toml:20: grid.finest = 0.02 is not grid.coarsest / 2^n; expected a "
       "halving of 0.0625, for example 0.015625"},
      {"finest = \"1/32\"", "finest = 0.5", "case.toml:20: grid.finest = 0.5 is not grid.coarsest / 2^n"},
      {"[[grid.region]]", "[[grid.region]]\nspacing = 0.03", "case.toml:23: grid.region.0.spacing = 0.03 is not"},
      {"[[grid.region]]", "[[grid.region]]\nspacing = \"1/64\"",
       "case.toml:23: grid.region.0.spacing = 0.015625 is below grid.finest = 0.03125"},
      {"[0.6, 0.6, 0.6]]", "[0.6, 0.6, -0.6]]", "case.toml:23: grid.region.0.box = "},
      {"box = [[-0.6, -0.6, -0.6], [0.6, 0.6, 0.6]]", "box = [[2, 2, 2], [3, 3, 3]]",
       "case.toml:23: grid.region.0.box = [[2, 2, 2], [3, 3, 3]] lies outside the domain"},
      {"box = [[-0.6, -0.6, -0.6], [0.6, 0.6, 0.6]]", "body = \"plat\"\ndistance = 0.1",
       "case.toml:23: grid.region.0.body = \"plat\" is not the name of a body"},
      {"viscosity = \"1/100\"", "viscosity = 1e3", "case.toml:15: fluid.viscosity = 1000 makes the relaxation time "},
      {"viscosity = \"1/100\"", "viscosity = 1e-9",
       "case.toml:15: fluid.viscosity = 1e-09 makes the relaxation time "
       "0.5000000024 on level 0 (cells of 0.0625 m); expected 0.5000001 to 2"},
      {"reference_velocity = 1", "reference_velocity = 1\nlattice_velocity = 0.2",
       "case.toml:17: fluid.lattice_velocity = 0.2 makes the Mach number 0.346; expected at most 0.3, that is 0.173"},
      {"reference_velocity = 1", "reference_velocity = 0.1",
       "case.toml:16: fluid.reference_velocity = 0.1 is too small: "
       "the largest velocity given, 1 m/s, has the Mach number 0.866"},
      {"viscosity = \"1/100\"", "viscosity = 0.01\nreynolds = 7\nreference_length = 1",
       "case.toml:15: fluid.viscosity = 0.01 contradicts fluid.reynolds = 7"},
      {"density = 1\n", "density = 1\nvolume_ratio = [1.5, 20]\n",
       "case.toml:28: body.plate.volume_ratio = [1.5, 20] does not enclose 1"},
      {"name = \"plate\"", "name = \"a plate\"", "case.toml:26: body.a plate.name = \"a plate\" is no plain name"},
      {"end = 2", "end = 2\n[results]\nstable_window = [1, 3]",
       "case.toml:39: results.stable_window = [1, 3] does not lie within the run, 0 to 2 s (time.end)"},
      {"end = 2", "end = 2\n[results]\nstable_window = [1, 1]",
       "case.toml:39: results.stable_window = [1, 1] does not"},
      {"end = 2", "end = 2\n[results]\npeak_from = 2",
       "case.toml:39: results.peak_from = 2 leaves no time for a peak; expected less than time.end = 2 s"},
      {"viscosity = \"1/100\"", "reynolds = 1e-4\nreference_length = 1",
       "case.toml:15: fluid.reynolds makes the viscosity 1e+04 m^2/s and the relaxation time "},
      {"coarsest = \"1/16\"", "coarsest = 1e-5", "case.toml:19: grid.coarsest = 1e-05 makes "},
      {"end = 2", "end = 2\n[results]\nbody = \"plte\"",
       "case.toml:39: results.body = \"plte\" is not the name of a body; did you mean plate?"},
      {"cd_stable =", "cd_stabel =",
       "case.toml:40: reference.cd_stabel is not the name of a result; did you mean cd_stable?"},
      {"value = 1.18", "value = 0", "case.toml:40: reference.cd_stable.value = 0; a relative difference"},
      {"value = 1.18", "below = 0",
       "case.toml:40: reference.cd_stable.below = 0 is out of range; expected a number above 0"},
      {"value = 1.18", "value = 1.18, below = 0.1", "case.toml:40: reference.cd_stable.value "},
  });
}

TEST(CaseErrors, bodies_need_names_of_their_own) {
  const CaseFolder folder;
  const std::size_t begin = plate_case.find("[[body]]"), end = plate_case.find("[time]");
  folder.write("case.toml", plate_case + "\n" + plate_case.substr(begin, end - begin));
  EXPECT_NE(message_of(folder.path()).find("body.plate.name is given to two bodies"), std::string::npos);
}

}  // namespace
}  // namespace drogue::app
