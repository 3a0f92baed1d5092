// SPDX-License-Identifier: GPL-3.0-or-later
#include "ib/delta.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace drogue::ib {
namespace {

class BothDeltas : public ::testing::TestWithParam<Delta> {
 protected:
  /// Calls check(s, weights) for markers at random places.
  template <class Check>
  void at_random_places(const Check& check) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-50.0, 50.0);
    for (int i = 0; i < 1000; ++i) {
      const double s = i < 3 ? 0.5 * i : place(random);
      check(s, axis_weights(GetParam(), s));
    }
  }
};

/// As printed: Peskin (2002) eq. 6.27; Roma et al. (1999) eq. 22.
double phi(Delta delta, double signed_r) {
  const double r = std::abs(signed_r);
  if (delta == Delta::peskin4) {
    if (r <= 1.0) return (3 - 2 * r + std::sqrt(1 + 4 * r - 4 * r * r)) / 8;
    return r <= 2.0 ? (5 - 2 * r - std::sqrt(-7 + 12 * r - 4 * r * r)) / 8 : 0.0;
  }
  if (r <= 0.5) return (1 + std::sqrt(1 - 3 * r * r)) / 3;
  return r <= 1.5 ? (5 - 3 * r - std::sqrt(1 - 3 * (1 - r) * (1 - r))) / 6 : 0.0;
}

// Near their ends the kernels are the small difference of numbers near one, under a root.
constexpr double round_off = 1e-13;

TEST_P(BothDeltas, weights_are_the_published_function) {
  at_random_places([&](double s, const AxisWeights& axis) {
    for (int i = -3; i < 7; ++i) {
      const double weight = i >= 0 && i < 4 ? axis.weight[i] : 0.0;
      EXPECT_NEAR(weight, phi(GetParam(), axis.low + i - s), 1e-7) << "s = " << s << ", i = " << i;
    }
  });
}

TEST_P(BothDeltas, weights_are_not_negative_and_sum_to_one) {
  at_random_places([&](double, const AxisWeights& axis) {
    double sum = 0.0;
    for (double w : axis.weight) {
      sum += w;
      EXPECT_GE(w, -round_off);
    }
    EXPECT_NEAR(sum, 1.0, round_off);
  });
}

TEST_P(BothDeltas, first_moment_vanishes) {
  at_random_places([&](double s, const AxisWeights& axis) {
    double moment = 0.0;
    for (int i = 0; i < 4; ++i) moment += (axis.low + i - s) * axis.weight[i];
    EXPECT_NEAR(moment, 0.0, round_off);
  });
}

TEST_P(BothDeltas, sum_of_squares_does_not_depend_on_the_place) {
  EXPECT_EQ(sum_phi_squared(Delta::peskin4), 0.375);
  EXPECT_EQ(sum_phi_squared(Delta::peskin3), 0.5);
  at_random_places([&](double, const AxisWeights& axis) {
    double sum = 0.0;
    for (double w : axis.weight) sum += w * w;
    EXPECT_NEAR(sum, sum_phi_squared(GetParam()), round_off);
  });
}

TEST_P(BothDeltas, wall_offset_is_where_a_profile_without_slip_at_the_markers_points) {
  constexpr int places = 100;
  double sum = 0.0;
  for (int place = 0; place < places; ++place) {
    const double s = 10.0 + static_cast<double>(place) / places;
    const AxisWeights axis = axis_weights(GetParam(), s);
    double u = 0.0, slope = 0.0, at_marker = 0.0;
    for (int i = 0; i < 4; ++i) {
      at_marker += axis.weight[i] * u;
      slope += axis.weight[i];
      u += slope;
    }
    const double points_at = axis.low + 4 - u / slope;  // where the straight profile beyond the last cell is zero
    sum += (points_at + at_marker / slope - s) / places;
  }
  EXPECT_NEAR(sum, wall_offset(GetParam()), 1e-3);
}

TEST(FourPointDelta, even_and_odd_cells_weigh_the_same) {
  for (double s = 0.0; s < 1.0; s += 0.01) {
    const auto w = axis_weights(Delta::peskin4, s).weight;
    EXPECT_NEAR(w[0] + w[2], 0.5, round_off);
  }
}

INSTANTIATE_TEST_SUITE_P(Delta, BothDeltas, ::testing::Values(Delta::peskin4, Delta::peskin3),
                         [](const auto& test) { return test.param == Delta::peskin4 ? "peskin4" : "peskin3"; });

}  // namespace
}  // namespace drogue::ib
