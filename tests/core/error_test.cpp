// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/error.hpp"

#include <gtest/gtest.h>

namespace drogue {
namespace {

TEST(Diverged, names_time_level_block_cell_and_position) {
  const Diverged error("velocity is not finite", 0.125, 2, 17, {1, 2, 15}, Vec3(0.5, -0.25, 1.0));
  EXPECT_STREQ(
      error.what(),
      "velocity is not finite at time 0.125 s, level 2, block 17, cell (1, 2, 15), position (0.5, -0.25, 1) m");
}

}  // namespace
}  // namespace drogue
