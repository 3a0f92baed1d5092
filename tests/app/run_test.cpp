// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <string>
#include <vector>

#include "app/case_reader.hpp"
#include "app/interrupt.hpp"
#include "app/run_folder.hpp"
#include "core/error.hpp"
#include "run_fixture.hpp"

namespace drogue::app {
namespace {

namespace fs = std::filesystem;

class Run : public RunTest {};

TEST_F(Run, leaves_history_summary_log_and_resolved_case) {
  options_.overrides = {"output.canopy=0.0125", "output.fluid=1"};
  EXPECT_EQ(run_case(options_), 0);
  const auto json = summary();
  EXPECT_EQ(json["finished"], true);
  EXPECT_EQ(json["case"], folder_.path().filename().string());
  EXPECT_NEAR(json["t_end"].get<double>(), 0.025, 1e-9);
  EXPECT_GT(json["mlups"].get<double>(), 0.0);
  EXPECT_GT(json["peak_rss_bytes"].get<double>(), 1e6);
  EXPECT_EQ(json["cells_per_level"].size(), 2u);
  double share = 0.0;
  for (const auto& part : json["time_share"]) share += part.get<double>();
  EXPECT_NEAR(share, 1.0, 1e-9);
  EXPECT_TRUE(json["results"]["cd_stable"].is_null()) << "the window was not reached";
  EXPECT_GT(json["results"]["cd_peak"].get<double>(), 0.0);

  const auto lines = history();
  ASSERT_EQ(lines.size(), 9u) << "a header and a row for every coarse step";
  EXPECT_TRUE(lines[0].starts_with("time [s],plate.force_x [N],")) << lines[0];
  const auto columns = std::ranges::count(lines[0], ',');
  for (const std::string& line : lines) EXPECT_EQ(std::ranges::count(line, ','), columns);

  for (const char* file : {"log.txt", "case.resolved.toml", "frames.csv", "fluid_000000.hdf", "canopy_000000.vtu",
                           "canopy_000002.vtu", "canopy.vtu.series", "fluid.hdf.series"}) {
    EXPECT_TRUE(fs::exists(options_.folder / file)) << file;
  }
  EXPECT_EQ(read_case(options_.folder / "case.resolved.toml").output.canopy, 0.0125);
}

TEST_F(Run, same_bits_for_any_number_of_threads) {
  const auto row_without_speed = [&](int threads) {
    options_.threads = threads;
    options_.force = true;
    run_case(options_);
    const std::string row = history().back();
    return row.substr(0, row.rfind(','));
  };
  const std::string one = row_without_speed(1);
  EXPECT_EQ(row_without_speed(2), one);
  EXPECT_EQ(row_without_speed(4), one);
}

TEST_F(Run, runs_without_a_body) {
  const std::size_t begin = plate_case.find("[[body]]"), end = plate_case.find("[time]");
  std::string text = plate_case;
  text.erase(begin, end - begin);
  folder_.write("case.toml", text.erase(text.find("[reference]")));
  EXPECT_EQ(run_case(options_), 0);
  EXPECT_EQ(history().front(), "time [s],max_mach [1],mass_drift [1],cell_updates [1],mlups [1e6/s]");
  EXPECT_TRUE(summary()["results"]["mass_drift"].is_number());
}

TEST_F(Run, never_overwrites_without_force) {
  ASSERT_EQ(run_case(options_), 0);
  const std::string place = options_.folder.string();
  EXPECT_EQ(error(), place + " holds a finished run; give --force to replace it, or another folder with -o");
  fs::remove(options_.folder / "summary.json");
  EXPECT_EQ(error(),
            place +
                " holds an unfinished run; give --continue to go on with it, --force to replace it, or another "
                "folder with -o");
  std::ofstream(options_.folder / "notes.md") << "mine";
  options_.force = true;
  options_.until = 0.0125;
  EXPECT_EQ(run_case(options_), 0);
  EXPECT_EQ(history().size(), 5u);
  EXPECT_TRUE(fs::exists(options_.folder / "notes.md")) << "what is not ours stays";
}

TEST_F(Run, keeps_other_runs_out_of_its_folder) {
  const FolderLock other_run(options_.folder);
  EXPECT_EQ(error(), "another run writes to " + options_.folder.string() + "; give another folder with -o");
}

TEST_F(Run, a_case_that_cannot_be_built_leaves_no_run) {
  options_.overrides = {"body.plate.mesh.centre=[0.93,0,0]"};
  EXPECT_NE(error().find("body.plate.mesh comes within"), std::string::npos);
  EXPECT_FALSE(fs::exists(options_.folder));
}

TEST_F(Run, a_diverged_run_keeps_what_it_has_and_says_so) {
  options_.overrides = {"body.plate.volume_ratio=[0.999999,1.000001]"};
  EXPECT_THROW(run_case(options_), Diverged);
  EXPECT_EQ(summary()["diverged"], true);
  EXPECT_EQ(summary()["finished"], false);
  EXPECT_FALSE(summary()["message"].get<std::string>().empty());
  EXPECT_TRUE(fs::exists(options_.folder / "history.csv"));
}

TEST_F(Run, an_interrupted_run_ends_between_steps_with_its_summary) {
  const Interrupt held;  // else the signal would end the test
  raise(SIGINT);
  EXPECT_EQ(run_case(options_), 130);
  EXPECT_EQ(summary()["interrupted"], true);
  EXPECT_EQ(summary()["finished"], false);
}

}  // namespace
}  // namespace drogue::app
