// SPDX-License-Identifier: GPL-3.0-or-later
// A case without bodies: what it measures of its flow, where the exact solution is known, and what can be wrong about
// it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/case_reader.hpp"
#include "app/history.hpp"
#include "app/plot.hpp"
#include "io/csv.hpp"
#include "io/plot.hpp"
#include "run_fixture.hpp"

namespace drogue::app {
namespace {

using std::numbers::pi;

const std::string vortex_case = R"toml(
[domain]
lower = [0, 0, 0]
upper = [1, 1, 0.5]
x_min = { type = "periodic" }
x_max = { type = "periodic" }
y_min = { type = "periodic" }
y_max = { type = "periodic" }
z_min = { type = "periodic" }
z_max = { type = "periodic" }

[fluid]
density = 1
viscosity = 0.02
reference_velocity = 1
reference_length = 2
lattice_velocity = 0.02
initial_velocity = ["sin(2*pi*x)*cos(2*pi*y)", "-cos(2*pi*x)*sin(2*pi*y)", 0]
initial_pressure = "(cos(4*pi*x)+cos(4*pi*y))/4"

[grid]
coarsest = "1/32"
finest = "1/32"

[time]
end = 0.25

[measure]
energy = true
exact_velocity = [
  "exp(-0.16*pi^2*t)*sin(2*pi*x)*cos(2*pi*y)",
  "-exp(-0.16*pi^2*t)*cos(2*pi*x)*sin(2*pi*y)",
  0,
]

[[measure.profile]]
name = "u"
from = [0, 0, 0.2]
to = [1, 0, 0.2]
points = 9
reference = "u.csv"

[output]
history = 0.05

[reference]
velocity_error = { below = 0.01, source = "exact" }
)toml";

class FlowCase : public RunTest {
 protected:
  FlowCase() {
    options_.until.reset();
    folder_.write("case.toml", vortex_case);
    folder_.write("u.csv", "# exact at the end\nx,u\n0.25,0.67385\n0.75,-0.67385\n");
  }
  io::CsvTable table(const std::string& name) const { return io::read_csv(options_.folder / name); }
  std::string message(const std::string& from, const std::string& to) {
    folder_.write("case.toml", replaced(vortex_case, from, to));
    const std::string prefix = folder_.path().string() + "/case.toml:";
    try {
      read_case(folder_.path());
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_TRUE(what.starts_with(prefix)) << what;
      return what.substr(what.find(' ') + 1);
    }
    return "no error";
  }
};

TEST_F(FlowCase, dissipation_is_that_of_the_exact_decay) {
  EXPECT_EQ(run_case(options_), 0);
  const io::CsvTable history = table("history.csv");
  const auto &time = *history.find("time"), &dissipation = *history.find("dissipation");
  ASSERT_EQ(time.size(), 5u);
  const auto energy = [](double t) { return 0.25 * std::exp(-0.32 * pi * pi * t); };
  for (std::size_t i = 0; i < time.size(); ++i) {
    EXPECT_NEAR((*history.find("kinetic_energy"))[i], energy(time[i]), 2e-3 * energy(time[i]));
    const double before = i > 0 ? time[i - 1] : 0.0;
    const double exact = (energy(before) - energy(time[i])) / (time[i] - before);
    EXPECT_NEAR(dissipation[i], exact, 0.01 * exact);
    const double viscous = 0.32 * pi * pi * energy(time[i]);
    EXPECT_NEAR((*history.find("enstrophy_dissipation"))[i], viscous, 5e-3 * viscous);
  }
  const auto results = summary()["results"];
  EXPECT_LT(results["velocity_error"], 2e-3);
  EXPECT_LT(results["rms_u"], 2e-3);
  EXPECT_TRUE(results["dissipation_peak"].is_null()) << "it only falls";
  EXPECT_EQ(summary()["references"]["velocity_error"]["agrees"], true);
}

TEST_F(FlowCase, profiles_are_written_at_the_end) {
  run_case(options_);
  const io::CsvTable profile = table("profile_u.csv");
  ASSERT_EQ(profile.columns.front().size(), 9u);
  for (int i = 0; i < 9; ++i) {
    const double x = i / 8.0;
    EXPECT_NEAR((*profile.find("distance"))[i], x, 1e-9);
    EXPECT_NEAR((*profile.find("u_x"))[i], std::exp(-0.04 * pi * pi) * std::sin(2 * pi * x), 3e-3);
  }
}

TEST_F(FlowCase, a_continued_run_goes_on_with_its_measurements) {
  run_case(options_);
  const auto rows = reproducible_history();
  const auto results = summary()["results"];
  options_.force = true;
  options_.until = 0.11;
  run_case(options_);
  options_.force = false;
  options_.resume = true;
  options_.until.reset();
  run_case(options_);
  auto continued = reproducible_history();
  ASSERT_EQ(continued.size(), rows.size() + 1) << "the end of the first part has a row of its own";
  EXPECT_EQ(continued[2], rows[2]);
  EXPECT_EQ(continued.back(), rows.back());
  EXPECT_EQ(summary()["results"], results);
}

TEST_F(FlowCase, is_drawn_against_its_references) {
  EXPECT_THROW(plot_run(options_.folder, {}), InputError) << "there is no run";
  run_case(options_);
  const auto picture = options_.folder / "plot.png";
  if (plot_run(options_.folder, {}) == picture.string() + "\n") {
    EXPECT_GT(std::filesystem::file_size(picture), 5000u);
  } else {
    GTEST_SKIP() << io::no_gnuplot;
  }
  std::filesystem::remove(options_.folder / "profile_u.csv");
  EXPECT_THROW(plot_run(options_.folder, {}), InputError) << "a part is missing";
}

TEST_F(FlowCase, only_what_is_asked_for_is_measured) {
  folder_.write("case.toml", replaced(vortex_case, "energy = true", "energy = false"));
  const History history(folder_.path() / "history.csv", read_case(folder_.path()));
  EXPECT_FALSE(history.trace().column.contains("dissipation"));
  EXPECT_TRUE(history.trace().column.contains("velocity_error"));
  EXPECT_TRUE(history.trace().column.contains("rms_u"));
}

TEST_F(FlowCase, mistakes_are_named) {
  const std::string folder = folder_.path().string();
  EXPECT_EQ(message("reference_length = 2", ""),
            "measure.energy = true needs fluid.reference_length, in whose units the dissipation is told");
  EXPECT_EQ(message("to = [1, 0, 0.2]", "to = [2, 0, 0.2]"),
            "measure.profile.u.to = [2, 0, 0.2] lies outside the domain");
  EXPECT_EQ(message("to = [1, 0, 0.2]", "to = [0, 0, 0.2]"), "measure.profile.u.to is where the line begins");
  EXPECT_EQ(message("to = [1, 0, 0.2]", "to = [0.5, 0, 0.2]"),
            "measure.profile.u.reference has a point 0.75 m from the beginning of a line of 0.5 m");
  EXPECT_EQ(message("name = \"u\"", "name = \"u 1\""),
            "measure.profile.u 1.name = \"u 1\" is no plain name; expected letters, digits, _ and -");
  EXPECT_EQ(message("points = 9", "component = \"w\""),
            "measure.profile.u.component = \"w\" is not known; expected \"x\", \"y\" or \"z\"");
  EXPECT_EQ(message("\"u.csv\"", "\"v.csv\""),
            "measure.profile.u.reference = \"" + folder + "/v.csv\": " + folder + "/v.csv cannot be read");
  folder_.write("u.csv", "x,u\n1,2\n3\n");
  EXPECT_EQ(message("points = 9", ""), "measure.profile.u.reference = \"" + folder + "/u.csv\": " + folder +
                                           "/u.csv:3: 1 values; expected 2, one for each name of the first line");
  folder_.write("u.csv", "x,u\n1,a\n");
  EXPECT_NE(message("points = 9", "").find("u.csv:2: \"a\" is not a number"), std::string::npos);
  folder_.write("u.csv", "x,u\n");
  EXPECT_NE(message("points = 9", "").find("holds no curve; expected two columns"), std::string::npos);
  EXPECT_EQ(message("density = 1", "density = 1\nforce = [\"x\", 0, 0]"),
            "fluid.force = \"x\" depends on the place; expected a formula in t alone");
  EXPECT_EQ(message("density = 1", "density = 1\nforce = [\"1/t\", 0, 0]"),
            "fluid.force = \"1/t\" is not finite at t = 0");
}

}  // namespace
}  // namespace drogue::app
