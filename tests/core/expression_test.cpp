// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/expression.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "core/error.hpp"

namespace drogue {
namespace {

const Vec3 place(0.25, -2.0, 3.0);

std::string error_of(const std::string& formula) {
  try {
    Expression expression(formula);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Expression, a_number_is_constant) {
  const Expression number(1.5);
  EXPECT_TRUE(number.is_constant());
  EXPECT_FALSE(number.depends_on_time());
  EXPECT_EQ(number(place, 7.0), 1.5);
  EXPECT_EQ(number.text(), "1.5");
}

TEST(Expression, a_formula_without_variables_is_constant) {
  const Expression fraction("1/64");
  EXPECT_TRUE(fraction.is_constant());
  EXPECT_EQ(fraction(place, 0.0), 1.0 / 64.0);
  EXPECT_EQ(Expression("2*pi")(place, 0.0), 2.0 * M_PI);
}

TEST(Expression, depends_on_place_and_time) {
  const Expression profile("0.5*(1-cos(pi*t))*y + x*z");
  EXPECT_FALSE(profile.is_constant());
  EXPECT_TRUE(profile.depends_on_time());
  for (double time : {0.0, 0.3, 1.0}) {
    const double expected = 0.5 * (1.0 - std::cos(M_PI * time)) * place.y() + place.x() * place.z();
    EXPECT_NEAR(profile(place, time), expected, 1e-15);
  }
  EXPECT_FALSE(Expression("1 - y^2").depends_on_time());
  EXPECT_EQ(Expression("t < 1 ? 2 : 3")(place, 0.5), 2.0);
  EXPECT_EQ(Expression("t < 1 ? 2 : 3")(place, 1.5), 3.0);
}

TEST(Expression, copies_are_independent_and_equal) {
  Expression original("x + t");
  Expression copy = original;
  EXPECT_EQ(copy(place, 1.0), original(place, 1.0));
  original = Expression(3.0);
  EXPECT_EQ(copy(place, 1.0), 1.25);
  EXPECT_TRUE(original.is_constant());
  const Expression moved = std::move(copy);
  EXPECT_EQ(moved(place, 2.0), 2.25);
  EXPECT_EQ(moved.text(), "x + t");
}

TEST(Expression, says_what_it_does_not_understand) {
  EXPECT_EQ(error_of("2*foo + 1"), "\"2*foo + 1\" has an unknown name \"foo\" at position 3");
  EXPECT_EQ(error_of("sin(x"), "\"sin(x\" lacks a closing parenthesis");
  EXPECT_EQ(error_of("1 +"), "\"1 +\" ends too early");
  EXPECT_EQ(error_of("1/0"), "\"1/0\" is not a finite number");
  EXPECT_EQ(error_of(" "), "an empty formula has no value");
  const std::string endless(60000, '1');
  EXPECT_EQ(error_of(endless), fmt::format("\"{}\" is too long", endless));
  EXPECT_NE(error_of("1 2").find("\"1 2\" has"), std::string::npos);
}

}  // namespace
}  // namespace drogue
