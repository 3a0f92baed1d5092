// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies from the case file to the run folder.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/case_reader.hpp"
#include "app/inspect.hpp"
#include "app/run.hpp"
#include "case_folder.hpp"
#include "core/error.hpp"

namespace drogue::app {
namespace {

/// The plate of the other tests replaced by a sphere that swings about the origin.
std::string sphere_case() {
  const std::size_t begin = plate_case.find("[[body]]"), end = plate_case.find("[time]");
  std::string text = plate_case;
  return text.replace(begin, end - begin, R"toml([[body]]
name = "ball"
shape = { type = "sphere", centre = [0, 0, 0], diameter = 0.4 }
motion = { translation = ["0.1*sin(2*t)", 0, 0], rotation = { angle = "t" } }

)toml");
}

const std::string sphere_line = R"(shape = { type = "sphere", centre = [0, 0, 0], diameter = 0.4 })";

template <class F>
std::string message_of(F command) {
  try {
    command();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

class RigidCase : public testing::Test {
 protected:
  RigidCase() { write(sphere_case()); }
  void write(const std::string& text) { folder_.write("case.toml", text); }
  std::string message() {
    return message_of([&] { read_case(folder_.path()); });
  }
  std::string header(const std::vector<std::string>& overrides = {}) {
    RunOptions options;
    options.path = folder_.path();
    options.folder = folder_.path() / "run";
    options.overrides = overrides;
    options.until = 0.025;
    options.force = options.quiet = true;
    run_case(options);
    std::ifstream stream(folder_.path() / "run" / "history.csv");
    std::string line;
    std::getline(stream, line);
    return line;
  }
  nlohmann::json results() const {
    return nlohmann::json::parse(std::ifstream(folder_.path() / "run" / "summary.json"))["results"];
  }
  CaseFolder folder_;
};

TEST_F(RigidCase, is_read_with_what_its_shape_suggests) {
  const Case c = read_case(folder_.path());
  const auto& body = std::get<RigidBody>(c.bodies.at(0).kind);
  EXPECT_NEAR(c.bodies[0].reference_area, 0.04 * std::acos(-1.0), 1e-15);
  EXPECT_EQ(body.shape.width, 0.4);
  EXPECT_EQ(body.coupling.fluid_density, 1.2);
  EXPECT_EQ(body.coupling.iterations, 1);
  EXPECT_NEAR(body.motion.pose(1.0)(Vec3::Zero()).x(), 0.1 * std::sin(2.0), 1e-15);
  EXPECT_NEAR(body.motion.twist(0.0, 1e-4).spin.z(), 1.0, 1e-9);
}

TEST_F(RigidCase, resolved_reads_back_to_itself) {
  const std::string first = read_case(folder_.path()).resolved;
  folder_.write("again/case.resolved.toml", first);
  EXPECT_EQ(read_case(folder_.path() / "again/case.resolved.toml").resolved, first);
}

TEST_F(RigidCase, mistakes_are_named_with_what_was_expected) {
  const std::vector<std::array<std::string, 3>> mistakes{
      {"\"sphere\"", "\"spere\"",
       "body.ball.shape.type = \"spere\" is not known; expected \"sphere\", \"cylinder\", \"plate\" or \"disk\"; did "
       "you mean sphere?"},
      {"diameter = 0.4", "diameter = 0", "body.ball.shape.diameter = 0 is out of range; expected a number above 0 [m]"},
      {", diameter = 0.4", "", "body.ball.shape.diameter is missing; expected a number above 0 [m]: of a sphere"},
      {"diameter = 0.4", "diameter = 0.4, length = 1", "body.ball.shape.length has no effect here (of a cylinder)"},
      {"name = \"ball\"", "name = \"ball\"\ndensity = 1", "body.ball.density has no effect here (own mass;"},
      {"\"0.1*sin(2*t)\"", "\"0.1*x\"",
       "body.ball.motion.translation = \"0.1*x\" depends on the place; expected a formula in t alone"},
      {"angle = \"t\"", "angle = \"t\", axis = [0, 0, 0]",
       "body.ball.motion.rotation.axis = [0, 0, 0] is no direction"},
      {"angle = \"t\"", "angel = \"t\"",
       "body.ball.motion.rotation.angel is not a known key; did you mean body.ball.motion.rotation.angle?"},
      {sphere_line, "surface = \"ball.obj\"\nreference_area = 1", "body.ball.surface = "},
      {"0.1*sin(2*t)", "0.1*sin(40*t)", "fluid.reference_velocity = 1 is too small: the largest velocity given, 4 m/s"},
      {"sphere\", centre = [0, 0, 0], diameter = 0.4",
       "cylinder\", axis = \"z\", ends = \"open\", length = 1, centre = [0, 0, 0], diameter = 0.4",
       "body.ball.shape.ends = \"open\" needs a cylinder as long as the domain, 2 m, along a periodic axis, but z is "
       "periodic and the length 1 m"},
      {"sphere\", centre = [0, 0, 0], diameter = 0.4", "plate\", normal = \"x\", centre = [0, 0, 0], size = [0.4, 0.4]",
       "no error"},
      {"[time]", "coupling.retraction = 3\n[time]", "body.ball.coupling.retraction = 3 is out of range; expected a "},
      {"cd_stable =", "centre_dx_peak =", "reference.centre_dx_peak is not the name of a result"},
  };
  for (const auto& [from, to, expected] : mistakes) {
    write(replaced(sphere_case(), from, to));
    EXPECT_NE(message().find(expected), std::string::npos) << message() << "\nexpected: " << expected;
    EXPECT_EQ(message().starts_with(folder_.path().string() + "/case.toml:"), expected != "no error");
  }
}

/// In a domain twice as wide, swinging out of the refined middle.
std::string far_swinging_case() {
  const std::string wide =
      replaced(sphere_case(), "lower = [-1, -1, -1]\nupper = [1, 1, 1]", "lower = [-2, -2, -2]\nupper = [2, 2, 2]");
  return replaced(wide, "0.1*sin(2*t)", "1.2*sin(t)");
}

TEST_F(RigidCase, must_lie_in_the_finest_cells_wherever_it_moves) {
  write(far_swinging_case());
  const std::string found = message_of([&] { check_report(folder_.path(), {}); });
  EXPECT_NE(found.find("body.ball.shape does not lie in cells of grid.finest = 0.03125 m"), std::string::npos) << found;
}

TEST_F(RigidCase, a_region_around_it_follows_its_motion) {
  write(
      replaced(far_swinging_case(), "box = [[-0.6, -0.6, -0.6], [0.6, 0.6, 0.6]]", "body = \"ball\"\ndistance = 0.12"));
  EXPECT_NE(check_report(folder_.path(), {}).find("is in order"), std::string::npos);
}

TEST_F(RigidCase, check_tells_of_its_markers) {
  const std::string report = check_report(folder_.path(), {});
  for (const char* fragment : {"ball: rigid, ", " markers ", "cells apart", "12.8 finest cells across"}) {
    EXPECT_NE(report.find(fragment), std::string::npos) << fragment << " in\n" << report;
  }
}

TEST_F(RigidCase, history_and_results_hold_what_means_something_for_it) {
  const std::string moving = header({"output.canopy=0.0125"});
  for (const char* column : {"ball.force_x [N]", "ball.torque_z [N m]", "ball.c_d [1]", "ball.c_l_y [1]",
                             "ball.centre_x [m]", "ball.slip_rms [m/s]", "ball.slip_max [m/s]"}) {
    EXPECT_NE(moving.find(column), std::string::npos) << column;
  }
  for (const char* column : {"centre_dx", "J_min", "reaction", "substeps", "wake_length"}) {
    EXPECT_EQ(moving.find(column), std::string::npos) << column;
  }
  EXPECT_FALSE(results().contains("wake_length"));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "run" / "canopy_000001.vtu"));

  write(replaced(sphere_case(), "motion = ", "# "));
  EXPECT_NE(header().find("ball.wake_length [1]"), std::string::npos) << "it stands still";
  EXPECT_TRUE(results().contains("wake_length"));
}

TEST_F(RigidCase, may_be_a_surface_from_a_file) {
  folder_.write("tetra.stl", R"(solid tetrahedron
facet normal 0 0 -1
outer loop
vertex 0 0 0
vertex 0 0.3 0
vertex 0.3 0 0
endloop
endfacet
facet normal 0 -1 0
outer loop
vertex 0 0 0
vertex 0.3 0 0
vertex 0 0 0.3
endloop
endfacet
facet normal -1 0 0
outer loop
vertex 0 0 0
vertex 0 0 0.3
vertex 0 0.3 0
endloop
endfacet
facet normal 1 1 1
outer loop
vertex 0.3 0 0
vertex 0 0.3 0
vertex 0 0 0.3
endloop
endfacet
endsolid
)");
  write(replaced(sphere_case(), sphere_line, "surface = \"tetra.stl\""));
  EXPECT_NE(message().find("body.ball.reference_area is missing"), std::string::npos) << message();
  write(replaced(sphere_case(), sphere_line, "surface = \"tetra.stl\"\nreference_area = 0.045"));
  EXPECT_NE(check_report(folder_.path(), {}).find("enclosing 0.0045 m^3"), std::string::npos);
  EXPECT_NE(header().find("ball.torque_x"), std::string::npos);
}

}  // namespace
}  // namespace drogue::app
