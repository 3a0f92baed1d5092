// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/fluid_snapshot.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <set>

#include "synthetic_run.hpp"
#include "temporary_folder.hpp"

namespace drogue {
namespace {

using test::FormulaFluid;
using test::TemporaryFolder;

FormulaFluid small_fluid() {
  const amr::Domain domain{{{-1.0, 0.0, 0.0}, {7.0, 4.0, 4.0}}, 0.25, {false, false, false}};
  amr::Forest forest(domain, 2, [](const Box& box, int) { return box.contains({0.6, 0.6, 0.6}); });
  return FormulaFluid(std::move(forest), {}, 1.25);
}

TEST(FluidSnapshot, every_block_reads_back_as_it_was_written) {
  const TemporaryFolder folder("snapshot_round_trip");
  const FormulaFluid fluid = small_fluid();
  io::write_fluid(folder / "fluid_000001.vtkhdf", fluid);
  const io::FluidSnapshot snapshot = io::read_fluid(folder / "fluid_000001.vtkhdf");

  const amr::Forest& forest = fluid.forest();
  EXPECT_DOUBLE_EQ(snapshot.time, 1.25);
  EXPECT_DOUBLE_EQ(io::read_fluid_time(folder / "fluid_000001.vtkhdf"), 1.25);
  EXPECT_EQ(snapshot.origin, forest.domain().box.lower);
  ASSERT_EQ(static_cast<int>(snapshot.levels.size()), forest.levels());
  const auto fields = std::make_unique<fluid::BlockFields>();
  for (int level = 0; level < forest.levels(); ++level) {
    const auto& stored = snapshot.levels[level];
    EXPECT_DOUBLE_EQ(stored.spacing, forest.spacing(level));
    EXPECT_EQ(static_cast<int>(stored.block.size()),
              forest.range(level, amr::Kind::leaf).size() + forest.range(level, amr::Kind::parent).size());
    for (std::size_t b = 0; b < stored.block.size(); ++b) {
      const int id = forest.find(level, stored.block[b]);
      ASSERT_NE(id, amr::none);
      fluid.read_block(id, *fields);
      for (int cell = 0; cell < amr::block_cells; ++cell) {
        const std::size_t n = b * amr::block_cells + static_cast<std::size_t>(cell);
        ASSERT_EQ(stored.pressure[n], fields->pressure[cell]);
        for (int a = 0; a < 3; ++a) ASSERT_EQ(stored.velocity[3 * n + a], fields->velocity[a][cell]);
      }
    }
  }
}

// What ParaView needs: level 0 fills the domain, every level lies inside the one above, no box twice.
TEST(FluidSnapshot, levels_are_nested_and_the_coarsest_fills_the_domain) {
  const TemporaryFolder folder("snapshot_nested");
  const FormulaFluid fluid = small_fluid();
  io::write_fluid(folder / "fluid.vtkhdf", fluid);
  const io::FluidSnapshot snapshot = io::read_fluid(folder / "fluid.vtkhdf");

  const Index3 across = fluid.forest().blocks_across(0);
  EXPECT_EQ(snapshot.levels[0].block.size(), static_cast<std::size_t>(across[0] * across[1] * across[2]));
  std::set<Index3> above;
  for (std::size_t level = 0; level < snapshot.levels.size(); ++level) {
    const std::set<Index3> blocks(snapshot.levels[level].block.begin(), snapshot.levels[level].block.end());
    EXPECT_EQ(blocks.size(), snapshot.levels[level].block.size());
    for (const Index3& b : blocks) EXPECT_TRUE(level == 0 || above.contains({b[0] / 2, b[1] / 2, b[2] / 2}));
    above = blocks;
  }
}

TEST(FluidSnapshot, boxes_without_children_cover_the_domain_exactly_once) {
  const TemporaryFolder folder("snapshot_cover");
  const FormulaFluid fluid = small_fluid();
  io::write_fluid(folder / "fluid.vtkhdf", fluid);
  const io::FluidSnapshot snapshot = io::read_fluid(folder / "fluid.vtkhdf");

  const Vec3 size = fluid.forest().domain().box.size();
  double volume = 0.0;
  for (std::size_t level = 0; level < snapshot.levels.size(); ++level) {
    std::set<Index3> children;
    if (level + 1 < snapshot.levels.size())
      for (const Index3& b : snapshot.levels[level + 1].block) children.insert({b[0] / 2, b[1] / 2, b[2] / 2});
    const double edge = snapshot.levels[level].spacing * amr::block_size;
    for (const Index3& b : snapshot.levels[level].block)
      if (!children.contains(b)) volume += edge * edge * edge;
  }
  EXPECT_NEAR(volume, size.prod(), 1e-12 * size.prod());
}

TEST(FluidSnapshot, no_temporary_file_is_left) {
  const TemporaryFolder folder("snapshot_names");
  const FormulaFluid fluid = small_fluid();
  io::write_fluid(folder / "fluid_000000.vtkhdf", fluid);
  io::write_fluid(folder / "fluid_000000.vtkhdf", fluid);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"fluid_000000.vtkhdf"});
}

TEST(FluidSnapshot, a_folder_that_cannot_be_made_is_named) {
  const TemporaryFolder folder("snapshot_error");
  std::ofstream(folder / "blocker") << "a file where a folder should be";
  try {
    io::write_fluid(folder / "blocker/fluid.vtkhdf", small_fluid());
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("blocker/fluid.vtkhdf"), std::string::npos) << error.what();
  }
}

// A full disk is imitated by a limit on the size of files, in a child so that the limit ends with it.
TEST(FluidSnapshotDeathTest, a_full_disk_throws_and_leaves_nothing_behind) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const TemporaryFolder folder("snapshot_full");
  const auto write_on_full_disk = [&] {
    const FormulaFluid fluid = small_fluid();
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{20'000, 20'000};
    setrlimit(RLIMIT_FSIZE, &limit);
    int status = 1;
    try {
      io::write_fluid(folder / "fluid.vtkhdf", fluid);
    } catch (const std::runtime_error& error) {
      const bool named = std::string(error.what()).find("fluid.vtkhdf") != std::string::npos;
      status = named && folder.names().empty() ? 0 : 2;
    }
    std::exit(status);
  };
  EXPECT_EXIT(write_on_full_disk(), testing::ExitedWithCode(0), "");
}

TEST(FluidSnapshot, what_is_no_snapshot_is_refused_by_name) {
  const TemporaryFolder folder("snapshot_refused");
  std::ofstream(folder / "fluid.vtkhdf") << "not HDF5";
  EXPECT_THROW(io::read_fluid(folder / "fluid.vtkhdf"), std::runtime_error);
  EXPECT_THROW(io::read_fluid(folder / "missing.vtkhdf"), std::runtime_error);
}

}  // namespace
}  // namespace drogue
