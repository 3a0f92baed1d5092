// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "core/error.hpp"
#include "fem/material.hpp"

namespace drogue::fem {
namespace {

using Deformation = Tensor<double>;

Deformation diagonal(double a, double b, double c) {
  return tensor<double>([&](int i, int j) { return i != j ? 0.0 : std::array{a, b, c}[i]; });
}

Deformation random_tensor(double mean, double amplitude, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  return tensor<double>([&](int i, int j) { return (i == j ? mean : 0.0) + uniform(generator); });
}

double largest(const Deformation& a) { return std::sqrt(dot(a, a)); }

const NeoHookean neo_hookean(1e3, 0.3, 0.3);
const SaintVenantKirchhoff saint_venant_kirchhoff(1e3, 0.3);

/// Stretch `free` that makes the stress along the third axis vanish, by Newton's method with the law's own tangent.
template <class Law, class Shape>
double free_stretch(const Law& law, const Shape& deformation, double guess) {
  double t = guess;
  for (int i = 0; i < 50; ++i) {
    const Deformation rate = deformation(t + 0.5) - deformation(t - 0.5);
    t -= law.stress(deformation(t))(2, 2) / law.tangent(deformation(t))(rate)(2, 2);
  }
  return t;
}

template <class Law>
void expect_uniaxial(const Law& law, double stretch, double stress, double lateral) {
  const auto shape = [&](double t) { return diagonal(stretch, t, t); };
  const double t = free_stretch(law, shape, 1.0 - 0.3 * (stretch - 1.0));
  EXPECT_NEAR(t / lateral, 1.0, 1e-5) << stretch;
  EXPECT_NEAR(law.stress(shape(t))(0, 0) / stress, 1.0, 1e-4) << stretch;
}

template <class Law>
void expect_equibiaxial(const Law& law, double stretch, double stress, double thickness) {
  const auto shape = [&](double t) { return diagonal(stretch, stretch, t); };
  const double t = free_stretch(law, shape, thickness + 0.01);
  EXPECT_NEAR(t / thickness, 1.0, 1e-5) << stretch;
  EXPECT_NEAR(law.stress(shape(t))(0, 0) / stress, 1.0, 1e-4) << stretch;
}

// Reference values computed independently from the paper's equations 5 to 10 with E = 1 kPa, nu = nu_stab = 0.3.
TEST(Materials, uniaxial_stress_follows_the_reference_table) {
  expect_uniaxial(neo_hookean, 0.90, -112.80, 1.03291);
  expect_uniaxial(neo_hookean, 1.05, 47.350, 0.98565);
  expect_uniaxial(neo_hookean, 1.10, 89.971, 0.97252);
  expect_uniaxial(neo_hookean, 1.20, 163.79, 0.94947);
  expect_uniaxial(neo_hookean, 1.30, 225.71, 0.93007);
  expect_uniaxial(neo_hookean, 1.50, 324.33, 0.89994);
  expect_uniaxial(saint_venant_kirchhoff, 0.90, -85.50, 1.02811);
  expect_uniaxial(saint_venant_kirchhoff, 1.05, 53.813, 0.98450);
  expect_uniaxial(saint_venant_kirchhoff, 1.10, 115.50, 0.96799);
  expect_uniaxial(saint_venant_kirchhoff, 1.20, 264.00, 0.93167);
  expect_uniaxial(saint_venant_kirchhoff, 1.30, 448.50, 0.89051);
  expect_uniaxial(saint_venant_kirchhoff, 1.50, 937.50, 0.79057);
}

TEST(Materials, equibiaxial_plane_stress_follows_the_reference_table) {
  expect_equibiaxial(neo_hookean, 0.90, -174.49, 1.08881);
  expect_equibiaxial(neo_hookean, 1.05, 65.188, 0.95808);
  expect_equibiaxial(neo_hookean, 1.10, 119.61, 0.91818);
  expect_equibiaxial(neo_hookean, 1.20, 204.24, 0.84487);
  expect_equibiaxial(neo_hookean, 1.30, 265.997, 0.78029);
  expect_equibiaxial(neo_hookean, 1.50, 348.23, 0.67499);
  expect_equibiaxial(saint_venant_kirchhoff, 0.90, -122.14, 1.07836);
  expect_equibiaxial(saint_venant_kirchhoff, 1.05, 76.875, 0.95506);
  expect_equibiaxial(saint_venant_kirchhoff, 1.10, 165.00, 0.90554);
  expect_equibiaxial(saint_venant_kirchhoff, 1.20, 377.14, 0.78921);
  expect_equibiaxial(saint_venant_kirchhoff, 1.30, 640.71, 0.63920);
}

template <class Law>
class Laws : public testing::Test {
 public:
  static Law law() {
    if constexpr (std::is_same_v<Law, NeoHookean>) {
      return {1e3, 0.3, 0.4};
    } else {
      return {1e3, 0.3};
    }
  }
};
using AllLaws = testing::Types<NeoHookean, SaintVenantKirchhoff>;
TYPED_TEST_SUITE(Laws, AllLaws);

// Central differences of step h err by h^2 and by round-off over h.
TYPED_TEST(Laws, stress_is_the_derivative_of_energy) {
  const auto law = this->law();
  constexpr double h = 1e-5;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Deformation f = random_tensor(1.0, 0.3, seed), df = random_tensor(0.0, 1.0, seed + 100);
    const double numeric = (law.energy(f + h * df) - law.energy(f - h * df)) / (2.0 * h);
    EXPECT_NEAR(dot(law.stress(f), df), numeric, 1e-6 * largest(law.stress(f)) + 1e-5) << seed;
  }
}

TYPED_TEST(Laws, tangent_is_the_derivative_of_stress) {
  const auto law = this->law();
  constexpr double h = 1e-5;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Deformation f = random_tensor(1.0, 0.3, seed), df = random_tensor(0.0, 1.0, seed + 100);
    const Deformation numeric = (0.5 / h) * (law.stress(f + h * df) - law.stress(f - h * df));
    EXPECT_LT(largest(law.tangent(f)(df) - numeric), 1e-6 * largest(numeric)) << seed;
  }
}

TYPED_TEST(Laws, tangent_has_the_symmetry_of_a_second_derivative) {
  const auto law = this->law();
  const Deformation f = random_tensor(1.0, 0.3, 1), a = random_tensor(0.0, 1.0, 2), b = random_tensor(0.0, 1.0, 3);
  EXPECT_NEAR(dot(a, law.tangent(f)(b)) / dot(b, law.tangent(f)(a)), 1.0, 1e-12);
}

TYPED_TEST(Laws, rotation_gives_no_stress_and_turns_the_stress_of_a_stretch) {
  const auto law = this->law();
  const double c = std::cos(1.0), s = std::sin(1.0);
  const Deformation r{{{c, -s, 0.0}, {s, c, 0.0}, {0.0, 0.0, 1.0}}};
  const Deformation quarter{{{0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}}};
  EXPECT_LT(largest(law.stress(r)), 1e-12 * law.shear);
  EXPECT_EQ(largest(law.stress(quarter)), 0.0);
  EXPECT_NEAR(law.energy(quarter), 0.0, 1e-12 * law.shear);
  const Deformation f = random_tensor(1.0, 0.2, 5);
  EXPECT_LT(largest(law.stress(r * f) - r * law.stress(f)), 1e-12 * largest(law.stress(f)));
}

TYPED_TEST(Laws, pack_and_double_agree_in_every_lane) {
  const auto law = this->law();
  Tensor<Pack> f, df;
  for (int lane = 0; lane < lanes; ++lane) {
    const Deformation of_lane = random_tensor(1.0, 0.3, lane), rate = random_tensor(0.0, 1.0, lane + 50);
    for (int k = 0; k < 9; ++k) {
      f(k / 3, k % 3)[lane] = of_lane(k / 3, k % 3);
      df(k / 3, k % 3)[lane] = rate(k / 3, k % 3);
    }
  }
  const Tensor<Pack> p = law.stress(f), dp = law.tangent(f)(df);
  for (int lane = 0; lane < lanes; ++lane) {
    const auto pick = [&](const Tensor<Pack>& t) {
      return tensor<double>([&](int i, int j) { return t(i, j)[lane]; });
    };
    EXPECT_LT(largest(pick(p) - law.stress(pick(f))), 1e-13 * law.shear);
    EXPECT_LT(largest(pick(dp) - law.tangent(pick(f))(pick(df))), 1e-12 * law.shear);
    EXPECT_NEAR(law.energy(f)[lane], law.energy(pick(f)), 1e-13 * law.shear);
  }
}

TEST(Materials, small_strain_moduli_are_those_of_young_and_poisson) {
  constexpr double strain = 1e-6;
  const auto check = [&](const auto& law) {
    const auto shape = [&](double t) { return diagonal(1.0 + strain, t, t); };
    const double t = free_stretch(law, shape, 1.0);
    EXPECT_NEAR(law.stress(shape(t))(0, 0) / strain, 1e3, 1e-2);
    EXPECT_NEAR((1.0 - t) / strain, 0.3, 1e-5);
  };
  check(neo_hookean);
  check(saint_venant_kirchhoff);
}

TEST(Materials, moduli_out_of_range_are_named) {
  const auto message = [](double young, double poisson, double stabilisation) -> std::string {
    try {
      NeoHookean(young, poisson, stabilisation);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(-5.0, 0.3, 0.3), "Young's modulus is -5 Pa; expected a positive number");
  EXPECT_EQ(message(1e3, 0.5, 0.3), "Poisson's ratio is 0.5; expected more than -1 and less than 0.5");
  EXPECT_EQ(message(1e3, 0.3, 0.7), "Poisson's ratio is 0.7; expected more than -1 and less than 0.5");
  EXPECT_THROW(SaintVenantKirchhoff(0.0, 0.3), InputError);
}

}  // namespace
}  // namespace drogue::fem
