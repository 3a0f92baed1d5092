// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/nearest_name.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace drogue {
namespace {

TEST(NearestName, distance_counts_single_edits) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("viscosity", "viscocity"), 1);
  EXPECT_EQ(edit_distance("desnity", "density"), 1);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(NearestName, distance_is_symmetric) {
  const std::vector<std::string> words{"run", "render", "check", "params", "info", "velocity", "x"};
  for (const auto& a : words) {
    for (const auto& b : words) EXPECT_EQ(edit_distance(a, b), edit_distance(b, a));
  }
}

TEST(NearestName, finds_what_was_meant_and_nothing_else) {
  const std::vector<std::string> commands{"run", "check", "params", "info", "render"};
  EXPECT_EQ(nearest_name("rnu", commands), "run");
  EXPECT_EQ(nearest_name("parms", commands), "params");
  EXPECT_EQ(nearest_name("zzzzzz", commands), "");
  EXPECT_EQ(nearest_name("xy", commands), "");
  EXPECT_EQ(did_you_mean("chekc", commands), "; did you mean check?");
  EXPECT_EQ(did_you_mean("zzzzzz", commands), "");
}

}  // namespace
}  // namespace drogue
