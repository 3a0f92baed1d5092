// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/fate.hpp"

#include <gtest/gtest.h>

#include "bench/report.hpp"
#include "temporary_folder.hpp"

namespace drogue::bench {
namespace {

using test::TemporaryFolder;

Fate shear_layer(const std::vector<std::string>& overrides, double lattice_velocity) {
  const TemporaryFolder folder;
  return follow(
      repository() / "bench/cases/shear_layer.toml", overrides,
      [&](app::Case& c) { c.fluid.lattice_velocity = lattice_velocity; }, Bound::energy, folder.path());
}

TEST(Fate, a_run_that_diverges_says_when_and_where) {
  const Fate fate = shear_layer({"fluid.collision=bgk", "fluid.reynolds=1e5"}, 0.2);
  EXPECT_EQ(fate.outcome, outcome::diverged);
  EXPECT_GT(fate.end, 0.1);
  EXPECT_LT(fate.end, 3.0);
  for (const char* part : {"diverged", "at time", "level 0", "block", "cell", "position"}) {
    EXPECT_NE(fate.message.find(part), std::string::npos) << part << " in " << fate.message;
  }
}

TEST(Fate, a_viscous_run_survives_and_loses_energy) {
  const Fate fate = shear_layer({"fluid.reynolds=100", "time.end=0.5"}, 0.1);
  EXPECT_EQ(fate.outcome, outcome::survived);
  EXPECT_GE(fate.end, 0.5);
  EXPECT_LT(fate.last, fate.largest) << "energy decays";
  EXPECT_LT(fate.largest, 1.0);
}

TEST(Fate, a_case_that_is_none_is_refused_with_its_message) {
  const Fate fate = shear_layer({"fluid.reynolds=-1"}, 0.1);
  EXPECT_EQ(fate.outcome, outcome::refused);
  EXPECT_NE(fate.message.find("fluid.reynolds"), std::string::npos) << fate.message;
}

}  // namespace
}  // namespace drogue::bench
