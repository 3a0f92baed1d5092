// SPDX-License-Identifier: GPL-3.0-or-later
// The quick form of each family, through the command line.
#include "bench/command.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/flop_count.hpp"
#include "bench/result_table.hpp"
#include "core/error.hpp"
#include "temporary_folder.hpp"

namespace drogue::bench {
namespace {

using test::TemporaryFolder, test::contents;

int run_quick(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--quick", "-o", folder.path()});
  return run_command(arguments);
}

std::string error_of(const std::vector<std::string>& arguments) {
  try {
    run_command(arguments);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Bench, kernel_measures_every_storage_from_memory_and_in_cache) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_quick(folder, {"kernel", "--threads", "1"}), 0);
  const std::string csv = contents(folder / "kernel.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "operator,storage,threads,cells,where,block_edge,mlups,mlups_median,noise,bytes_per_update,"
            "share_of_bandwidth,flops_per_update,share_of_arithmetic");
  for (const char* storage : {"half_stress", "float32", "float64"}) {
    for (const char* where : {"memory", "cache"}) {
      EXPECT_NE(csv.find(std::string("hrr,") + storage + ",1,"), std::string::npos);
      EXPECT_NE(csv.find(where), std::string::npos);
    }
  }
  for (const char* file : {"kernel_costs.csv", "kernel_floors.csv", "kernel.md"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
  }
}

TEST(Bench, arithmetic_is_counted_from_the_formulas) {
  using fluid::Collision, fluid::EddyViscosity;
  const int bgk = flops_per_update(Collision::bgk, EddyViscosity::none);
  const int rr = flops_per_update(Collision::rr, EddyViscosity::none);
  const int hrr = flops_per_update(Collision::hrr, EddyViscosity::none);
  EXPECT_GT(bgk, 19 * 4) << "19 populations of a few operations each";
  EXPECT_GT(rr, bgk);
  EXPECT_GT(hrr, rr);
  EXPECT_GT(flops_per_update(Collision::hrr, EddyViscosity::vreman), hrr);
}

TEST(Bench, finished_runs_of_accuracy_are_not_made_again) {
  const TemporaryFolder folder;
  const std::vector<std::string> arguments{"accuracy", "--only", "taylor_green"};
  ASSERT_EQ(run_quick(folder, arguments), 0);
  const std::string csv = contents(folder / "accuracy_taylor_green.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "operator,lattice_velocity,cells,error,seconds,cell_updates,mlups,message");
  EXPECT_GT(std::ranges::count(csv, '\n'), 3);
  ASSERT_EQ(run_quick(folder, arguments), 0);
  EXPECT_EQ(contents(folder / "accuracy_taylor_green.csv"), csv) << "times would differ";
  EXPECT_NE(contents(folder / "accuracy.md").find("The cheapest setting"), std::string::npos);
}

TEST(Bench, only_missing_runs_of_stability_are_made) {
  const TemporaryFolder folder;
  const std::vector<std::string> arguments{"stability", "--only", "elastic_plate"};
  const auto file = folder / "stability_elastic_plate.csv";
  const Row columns{"scheme", "young", "mass_ratio", "outcome", "end", "largest", "last", "message"};
  ResultTable(file, columns).append({"default", "1e3", "1", "silent", "7", "1", "1", "made up"});
  ASSERT_EQ(run_quick(folder, arguments), 0);
  const ResultTable table(file, columns);
  EXPECT_EQ(table.rows().size(), 4u);
  EXPECT_EQ(table.text(table.rows().front(), "message"), "made up");
  for (std::size_t i = 1; i < table.rows().size(); ++i) EXPECT_EQ(table.text(table.rows()[i], "outcome"), "survived");
}

TEST(Bench, names_the_nearest_family) {
  EXPECT_EQ(error_of({"kernle"}),
            "kernle is no benchmark (there are kernel, accuracy, stability); did you mean kernel?");
  EXPECT_NE(error_of({"stability", "--only", "sudden_event"}).find("did you mean sudden_events?"), std::string::npos);
  EXPECT_NE(error_of({"kernel", "--fast"}).find("--fast"), std::string::npos);
}

}  // namespace
}  // namespace drogue::bench
