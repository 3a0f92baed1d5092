// SPDX-License-Identifier: GPL-3.0-or-later
#include "fluid/probe.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "formula_fluid.hpp"

namespace drogue::fluid {
namespace {

using testing::FormulaFluid;
using testing::unit_cube;

const std::vector<Vec3> places{Vec3(0.503, 0.41, 0.77), Vec3(0.5, 0.5, 0.5), Vec3(0.01, 0.33, 0.99),
                               Vec3(0.0, 0.0, 0.0),     Vec3(1.0, 0.2, 1.0), Vec3(0.48, 0.51, 0.02)};

TEST(Probe, reproduces_cubic_fields_up_to_the_walls) {
  const std::array<Expression, 3> cubic{Expression("x^3-y"), Expression("x*y*z+z^3"), Expression("y^3*x^2")};
  const FormulaFluid fluid(unit_cube(16, false), cubic, Expression("z^2+1"));
  Probe probe(fluid);
  for (const Vec3& place : places) {
    const auto flow = probe(place).value();
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(flow.velocity[a], cubic[a](place, 0.0), 3e-6) << place.transpose();
    EXPECT_NEAR(flow.pressure, place.z() * place.z() + 1.0, 3e-6);
  }
}

TEST(Probe, reproduces_linear_fields_across_levels) {
  const std::array<Expression, 3> linear{Expression("1+x-2*y"), Expression("z"), Expression("x+y+z")};
  const FormulaFluid fluid(unit_cube(32, false, true), linear);
  ASSERT_EQ(fluid.forest().levels(), 2);
  Probe probe(fluid);
  for (const Vec3& place : places) {
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(probe(place)->velocity[a], linear[a](place, 0.0), 2e-6);
  }
}

TEST(Probe, is_of_second_order_or_better_beside_a_change_of_level) {
  const std::array<Expression, 3> wave{Expression("sin(5*x+3*y)"), Expression(0.0), Expression(0.0)};
  const auto error = [&](int across) {
    const FormulaFluid fluid(unit_cube(across, false, true), wave);
    Probe probe(fluid);
    double largest = 0.0;
    for (double x = 0.42; x < 0.58; x += 0.003) {
      const Vec3 place(x, 0.31, 0.4);
      largest = std::max(largest, std::abs(probe(place)->velocity[0] - wave[0](place, 0.0)));
    }
    return largest;
  };
  EXPECT_GT(std::log2(error(64) / error(128)), 1.8) << "1.75, 1.87, ...";
}

TEST(Probe, wraps_where_the_domain_does_and_ends_where_it_ends) {
  const std::array<Expression, 3> wave{Expression("sin(2*pi*x)"), Expression(0.0), Expression(0.0)};
  const FormulaFluid periodic(unit_cube(32, true), wave), closed(unit_cube(32, false), wave);
  EXPECT_NEAR(Probe(periodic)(Vec3(1.25, 0.5, -0.3))->velocity[0], 1.0, 1e-4);
  EXPECT_NEAR(Probe(periodic)(Vec3(0.999, 0.5, 0.5))->velocity[0], -0.00628, 1e-5) << "the stencil wraps as well";
  EXPECT_FALSE(Probe(closed)(Vec3(1.25, 0.5, 0.3)));
}

}  // namespace
}  // namespace drogue::fluid
