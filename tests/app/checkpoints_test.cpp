// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/checkpoints.hpp"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "app/interrupt.hpp"
#include "io/checkpoint.hpp"
#include "io/series.hpp"
#include "run_fixture.hpp"

namespace drogue::app {
namespace {

namespace fs = std::filesystem;

constexpr double step = 0.003125;  // coarse [s]

class Continue : public RunTest {
 protected:
  int run(double until, bool resume, int threads = 1) {
    options_.until = until;
    options_.resume = resume;
    options_.threads = threads;
    return run_case(options_);
  }
  std::vector<fs::path> checkpoints() const { return io::list_checkpoints(options_.folder); }
};

TEST_F(Continue, a_continued_run_is_the_one_that_never_stopped) {
  options_.overrides = {"output.canopy=0.0125", "output.fluid=0.02", "output.history=0.00625"};
  run(10 * step, false);
  const auto rows = reproducible_history(), frames = lines("frames.csv"), fluid = lines("fluid.hdf.series");
  const auto before = summary();

  // As if killed after 8 steps when the last checkpoint is of 4: rows and snapshots go on beyond it.
  options_.force = true;
  run(4 * step, false);
  options_.force = false;
  run(8 * step, true);
  fs::remove(checkpoints().back());
  fs::remove(options_.folder / "summary.json");
  EXPECT_EQ(run(10 * step, true, 2), 0);

  EXPECT_EQ(reproducible_history(), rows);
  EXPECT_EQ(lines("frames.csv"), frames);
  EXPECT_EQ(lines("fluid.hdf.series"), fluid);
  EXPECT_EQ(io::read_series(options_.folder / "canopy.vtu.series").size(), 3u);
  const auto after = summary();
  for (const char* key : {"results", "references", "t_end", "cell_updates"}) EXPECT_EQ(after[key], before[key]);
  double share = 0.0;
  for (const auto& part : after["time_share"]) share += part.get<double>();
  EXPECT_NEAR(share, 1.0, 1e-9);
}

TEST_F(Continue, what_was_recorded_after_the_checkpoint_is_taken_back) {
  options_.overrides = {"output.canopy=0.0125"};
  run(3 * step, false);
  run(5 * step, true);
  ASSERT_TRUE(fs::exists(options_.folder / "canopy_000001.vtu"));
  fs::remove(checkpoints().back());
  run(3 * step, true);
  EXPECT_EQ(history().size(), 4u);
  EXPECT_EQ(lines("frames.csv").size(), 2u);
  EXPECT_EQ(io::read_series(options_.folder / "canopy.vtu.series").size(), 1u);
  EXPECT_FALSE(fs::exists(options_.folder / "canopy_000001.vtu"));
}

TEST_F(Continue, goes_on_where_it_was_interrupted) {
  const Interrupt held;  // the thread inherits it, so that the signal waits for the run to look
  std::thread user([&] {
    while (history().size() < 4) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(getpid(), SIGINT);
  });
  EXPECT_EQ(run(1.0, false), 130);
  user.join();
  const double reached = summary()["t_end"];
  ASSERT_EQ(checkpoints().size(), 1u);
  EXPECT_EQ(run(reached + 2 * step, true), 0);
  const auto continued = reproducible_history();
  EXPECT_EQ(summary()["finished"], true);
  options_.force = true;
  run(reached + 2 * step, false);
  EXPECT_EQ(reproducible_history(), continued);
}

TEST_F(Continue, the_newest_two_are_kept_and_a_damaged_one_is_passed_over) {
  options_.overrides = {"output.checkpoint=1e-9"};
  run(8 * step, false);
  const auto rows = reproducible_history();
  ASSERT_EQ(checkpoints(),
            (std::vector{io::checkpoint_path(options_.folder, 7), io::checkpoint_path(options_.folder, 8)}));
  fs::resize_file(checkpoints().back(), fs::file_size(checkpoints().back()) / 2);
  EXPECT_EQ(run(8 * step, true), 0);
  EXPECT_EQ(reproducible_history(), rows);
  EXPECT_EQ(checkpoints().back(), io::checkpoint_path(options_.folder, 8)) << "the damaged one is replaced";

  for (const fs::path& file : checkpoints()) fs::resize_file(file, 1000);
  EXPECT_EQ(error(), options_.folder.string() + " holds no checkpoint that can be read; give --force to start again");
}

TEST_F(Continue, a_diverged_run_keeps_the_last_good_state_and_names_it) {
  options_.overrides = {"output.checkpoint=1e-9", "body.plate.volume_ratio=[0.9,1.01]"};  // torn in the fifth step
  options_.until = 20 * step;
  const std::string message = error<Diverged>();
  ASSERT_FALSE(checkpoints().empty()) << message;
  EXPECT_NE(message.find(checkpoints().back().string() + " keeps the state at "), std::string::npos) << message;
  EXPECT_EQ(summary()["message"], message);
  const std::size_t rows = history().size();
  options_.resume = true;
  EXPECT_EQ(error<Diverged>(), message) << "the same state, the same end";
  EXPECT_EQ(history().size(), rows);
}

TEST_F(Continue, only_when_it_ends_and_what_it_shows_may_change) {
  run(2 * step, false);
  options_.overrides = {"time.end=3", "output.canopy=0.5", "results.peak_from=0.001", "title=Longer",
                        "reference.cd_stable.within=0.2"};
  EXPECT_EQ(run(3 * step, true), 0);
  EXPECT_EQ(summary()["title"], "Longer");

  options_.overrides = {"fluid.viscosity=0.02", "body.plate.hold.0.patch=0.05", "output.canopy=1"};
  EXPECT_EQ(error(), options_.folder.string() +
                         " holds the run of another case: body.plate.hold.0.patch was 0.1 and is 0.05, fluid.viscosity "
                         "was 0.01 and is 0.02; only title, time.end, output, results, reference may change in a run "
                         "that is continued, so give --force to replace it, or another folder with -o");
  EXPECT_EQ(history().size(), 4u) << "nothing is touched";
}

TEST_F(Continue, a_state_of_another_size_is_refused) {
  run(step, false);
  options_.folder = folder_.path() / "other";
  options_.overrides = {"domain.upper=[3,1,1]"};
  run(step, false);
  fs::copy_file(folder_.path() / "run/checkpoint_000001.h5", checkpoints().back(),
                fs::copy_options::overwrite_existing);
  options_.resume = true;
  EXPECT_NE(error().find("level0/moments has "), std::string::npos) << error();
}

TEST_F(Continue, needs_a_run_with_a_checkpoint) {
  options_.resume = true;
  EXPECT_EQ(error(), options_.folder.string() + " holds no run to continue");
  options_.overrides = {"output.checkpoint=0"};
  run(step, false);
  EXPECT_TRUE(checkpoints().empty());
  options_.resume = true;
  EXPECT_EQ(error(), options_.folder.string() + " holds no checkpoint that can be read; give --force to start again");
}

}  // namespace
}  // namespace drogue::app
