// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "fem/simd_math.hpp"

namespace drogue::fem {
namespace {

// The two templates at a double and at every lane of a pack, which may differ by contraction only.
template <class Function, class Reference>
double largest_error(const Function& function, const Reference& reference, double first, double ratio, double step,
                     int count) {
  double largest = 0.0, x = first;
  for (int i = 0; i < count; ++i, x = x * ratio + step) {
    const long double exact = reference(static_cast<long double>(x));
    const double scale = std::max(1.0, std::abs(static_cast<double>(exact)));
    Pack pack = splat<Pack>(1.0);
    pack[i % lanes] = x;
    for (const double value : {function(x), function(pack)[i % lanes]}) {
      largest = std::max(largest, static_cast<double>(std::abs(value - exact)) / scale);
    }
  }
  return largest;
}

TEST(SimdMath, logarithm_is_accurate_over_the_whole_range) {
  const auto log_of = [](const auto& x) { return log(x); };
  const auto exact = [](long double x) { return std::log(x); };
  EXPECT_LT(largest_error(log_of, exact, 1e-300, 1.013, 0.0, 100000), 4e-16);
  EXPECT_LT(largest_error(log_of, exact, 0.05, 1.0, 2e-4, 100000), 4e-16);
}

TEST(SimdMath, logarithm_near_one_keeps_its_relative_accuracy) {
  for (double offset = 1e-15; offset < 0.3; offset *= 1.7) {
    for (const double x : {1.0 + offset, 1.0 - offset}) EXPECT_NEAR(log(x) / std::log(x), 1.0, 6e-16) << x;
  }
  EXPECT_EQ(log(1.0), 0.0);
}

TEST(SimdMath, exponential_is_accurate_in_relative_terms) {
  const auto ratio = [](const auto& x) { return exp(x) * exp(-x); };
  const auto one = [](long double) { return 1.0L; };
  EXPECT_LT(largest_error(ratio, one, -690.0, 1.0, 0.0137, 100000), 2e-15);
  for (double x = -690.0; x < 690.0; x += 0.1137) EXPECT_NEAR(exp(x) / std::exp(x), 1.0, 8e-16) << x;
  EXPECT_EQ(exp(0.0), 1.0);
}

TEST(SimdMath, volumetric_factor_of_the_laws_is_accurate) {
  const auto factor = [](const auto& j) { return exp(log(j) * (-2.0 / 3.0)); };
  for (double j = 0.05; j < 20.0; j *= 1.001) EXPECT_NEAR(factor(j) * std::cbrt(j * j), 1.0, 2e-15) << j;
}

}  // namespace
}  // namespace drogue::fem
