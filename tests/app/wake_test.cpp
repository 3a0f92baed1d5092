// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/wake.hpp"

#include <gtest/gtest.h>

#include "lbm/solver.hpp"

namespace drogue::app {
namespace {

/// A fluid at t = 0 whose velocity along (1, 1, 0) is a formula; the finest cells, 1/32 m, end at x = 1 m.
lbm::Solver flow_along_diagonal(const std::string& formula) {
  fluid::Specification s{};
  s.density = s.reference_velocity = 1.0;
  s.viscosity = 0.01;
  s.initial_velocity[0] = s.initial_velocity[1] = Expression(formula);
  for (fluid::Face& face : s.face) face.type = fluid::Boundary::outlet;
  const amr::Domain domain{{Vec3(-2, -2, -2), Vec3(4, 4, 2)}, 1.0 / 16};
  return {amr::Forest(domain, 1, amr::refine_box({Vec3(-1, -1, -1), Vec3(1, 1, 1)}, domain.coarsest, 1.0 / 32)), s};
}

const Vec3 rear(0.01, -0.02, 0.005), along = Vec3(1.0, 1.0, 0.0).normalized();

TEST(Wake, ends_where_the_flow_turns_forward_also_beyond_the_finest_cells) {
  const double place = (rear.x() + rear.y()) / std::sqrt(2.0);
  for (double end : {0.4, 2.0}) {
    const lbm::Solver fluid = flow_along_diagonal("0.01*((x+y)/sqrt(2)-" + std::to_string(place + end) + ")");
    EXPECT_NEAR(wake_length(fluid, rear, along), end, 1e-4) << "exact for a linear profile";
  }
}

TEST(Wake, has_no_length_without_backward_flow_or_without_an_end) {
  EXPECT_EQ(wake_length(flow_along_diagonal("0.05"), rear, along), 0.0);
  EXPECT_EQ(wake_length(flow_along_diagonal("-0.05"), rear, along), 0.0);
}

}  // namespace
}  // namespace drogue::app
