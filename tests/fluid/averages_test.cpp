// SPDX-License-Identifier: GPL-3.0-or-later
#include "fluid/averages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "formula_fluid.hpp"

namespace drogue::fluid {
namespace {

using std::numbers::pi;
using testing::FormulaFluid;
using testing::unit_cube;

const std::array<Expression, 3> vortex{Expression("sin(2*pi*x)*cos(2*pi*y)*cos(2*pi*z)"),
                                       Expression("-cos(2*pi*x)*sin(2*pi*y)*cos(2*pi*z)"), Expression(0.0)};

TEST(Averages, the_energy_of_the_taylor_green_vortex_is_an_eighth) {
  EXPECT_NEAR(kinetic_energy(FormulaFluid(unit_cube(16, true), vortex)), 0.125, 1e-7);
  EXPECT_NEAR(kinetic_energy(FormulaFluid(unit_cube(32, true, true), vortex)), 0.125, 1e-7)
      << "each level counts with its volume";
}

TEST(Averages, the_enstrophy_of_the_taylor_green_vortex_converges_at_fourth_order) {
  const double exact = 0.375 * 4.0 * pi * pi;  // in a box of 2 pi it is 3/8
  const double coarse = enstrophy(FormulaFluid(unit_cube(16, true), vortex)) / exact - 1.0;
  const double fine = enstrophy(FormulaFluid(unit_cube(32, true), vortex)) / exact - 1.0;
  EXPECT_LT(std::abs(fine), 1e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.1);
}

TEST(Averages, the_enstrophy_of_cubic_shear_is_exact_also_beside_walls_and_levels) {
  const std::array<Expression, 3> shear{Expression("y^3"), Expression("2*x"), Expression(0.0)};
  for (const bool refined : {false, true}) {
    const FormulaFluid fluid(unit_cube(32, false, refined), shear);
    double exact = 0.0, volume = 0.0;  // <(2 - 3 y^2)^2> / 2 over the cells
    for (int level = 0; level < fluid.forest().levels(); ++level) {
      const auto leaves = fluid.forest().range(level, amr::Kind::leaf);
      const double cell = std::pow(fluid.forest().spacing(level), 3);
      for (int id = leaves.begin; id < leaves.end; ++id) {
        for (int c = 0; c < amr::block_cells; ++c) {
          const double y = fluid.forest().cell_centre(id, amr::cell_at(c)).y();
          exact += cell * 0.5 * std::pow(2.0 - 3.0 * y * y, 2);
          volume += cell;
        }
      }
    }
    EXPECT_NEAR(enstrophy(fluid), exact / volume, refined ? 2e-3 : 1e-5);
  }
}

TEST(Averages, the_error_is_relative_to_the_velocity_given) {
  const FormulaFluid fluid(unit_cube(16, true), vortex);
  EXPECT_LT(relative_velocity_error(fluid, vortex), 1e-7);
  const std::array<Expression, 3> smaller{Expression("0.5*t/1.5*" + vortex[0].text()),
                                          Expression("0.5*t/1.5*" + vortex[1].text()), Expression(0.0)};
  EXPECT_NEAR(relative_velocity_error(fluid, smaller), 1.0, 1e-6) << "formulas are taken at the time of the fluid";
}

}  // namespace
}  // namespace drogue::fluid
