// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of the D3Q19 series and of one block's step.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "lbm/d3q19.hpp"
#include "lbm/eddy_viscosity.hpp"
#include "lbm/stream_collide.hpp"

namespace drogue::lbm {
namespace {

using fluid::Collision, fluid::EddyViscosity;

using Moments = std::array<float, moments>;

/// Populations of one cell, by template access as the kernel's.
struct Cell {
  HermiteSeries<float> series;
  template <int cx, int cy, int cz>
  float get() const {
    return series.population<cx, cy, cz>();
  }
};

Moments random_moments(std::mt19937& generator) {
  std::uniform_real_distribution<float> u(-0.1f, 0.1f), p(-1e-2f, 1e-2f);
  Moments m;
  for (int i = 0; i < moments; ++i) m[i] = i < 4 ? u(generator) : p(generator);
  return m;
}

TEST(Lattice, reconstruction_followed_by_moments_is_the_identity_when_nothing_relaxes) {
  std::mt19937 generator(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Moments m = random_moments(generator);
    const Moments back = moments_of<float>(Cell{HermiteSeries<float>(m, 1.0f)});
    for (int i = 0; i < moments; ++i) EXPECT_NEAR(back[i], m[i], 3e-7f) << "moment " << i;
  }
}

TEST(Lattice, collision_keeps_mass_and_momentum_and_scales_the_stress) {
  std::mt19937 generator(2);
  const float keep = -0.9f;  // tau just above one half
  for (int trial = 0; trial < 100; ++trial) {
    const Moments m = random_moments(generator);
    const Moments after = moments_of<float>(Cell{HermiteSeries<float>(m, keep)});
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(after[i], m[i], 3e-7f);
    for (int i = 4; i < moments; ++i) EXPECT_NEAR(after[i], keep * m[i], 3e-7f);
  }
}

TEST(Lattice, equilibrium_has_the_moments_of_a_maxwellian_to_second_order) {
  const Moments equilibrium{0.02f, 0.05f, -0.03f, 0.08f, 0, 0, 0, 0, 0, 0};
  const Moments m = moments_of<float>(Cell{HermiteSeries<float>(equilibrium, 0.0f)});
  for (int i = 0; i < moments; ++i) EXPECT_NEAR(m[i], equilibrium[i], 2e-7f);
}

/// One block whose 26 neighbours are itself: a periodic box of 16^3 cells.
template <class S>
class PeriodicBlock {
 public:
  using Layout = RowLayout<S>;
  using Real = typename S::Real;

  PeriodicBlock() : field_{MomentField<S>(1), MomentField<S>(1)} {}
  explicit PeriodicBlock(unsigned seed) : PeriodicBlock() {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<Real> u(-0.02f, 0.02f), p(-1e-4f, 1e-4f);
    fill([&](int m, const Index3&) { return m < 4 ? u(generator) : p(generator); });
  }

  /// `value` of a moment and a cell.
  template <class Value>
  void fill(const Value& value) {
    for (int cell = 0; cell < amr::block_cells; ++cell)
      for (int m = 0; m < moments; ++m) {
        const Index3 at = amr::cell_at(cell);
        Layout::put(field_[now_].row(0, at[1], at[2]), m, at[0], static_cast<Real>(value(m, at)));
      }
    field_[now_].refresh_columns(0);
  }

  void step(const Relaxation& relaxation, Collision collision = Collision::hrr,
            EddyViscosity eddy = EddyViscosity::none, bool with_columns = true) {
    BlockNeighbourhood<S> blocks;
    blocks.source.fill(field_[now_].block(0));
    blocks.columns.fill(with_columns ? field_[now_].columns(0) : nullptr);
    blocks.target = field_[1 - now_].block(0);
    blocks.target_columns = field_[1 - now_].columns(0);
    record = block_update<S>(collision, eddy)(blocks, relaxation);
    now_ = 1 - now_;
  }

  Real get(int m, int x, int y, int z) const { return Layout::get(field_[now_].row(0, y, z), m, x); }
  Real column(int side, int m, int y, int z) const {
    return Layout::get(field_[now_].columns(0) + (side * lanes + z) * Layout::bytes, m, y);
  }

  std::array<double, 4> totals() const {
    std::array<double, 4> sum{};
    for (int cell = 0; cell < amr::block_cells; ++cell) {
      const auto [x, y, z] = amr::cell_at(cell);
      const double rho = 1.0 + double{get(drho, x, y, z)};
      sum[0] += rho - 1.0;
      for (int a = 0; a < 3; ++a) sum[1 + a] += rho * get(ux + a, x, y, z);
    }
    return sum;
  }

  BlockRecord record;

 private:
  std::array<MomentField<S>, 2> field_;
  int now_ = 0;
};

/// `digit`: relative round-off of what is stored.
template <class S>
void expect_conservation(double digit, EddyViscosity eddy = EddyViscosity::none) {
  PeriodicBlock<S> block(7);
  const auto before = block.totals();
  constexpr int steps = 50;
  for (int i = 0; i < steps; ++i) block.step({0.51, 0.98, 0.01}, Collision::hrr, eddy);
  const auto after = block.totals();
  // round-off per cell and step, as a random walk over cells and steps
  const double bound = digit * 0.02 * std::sqrt(4096.0 * steps) * 8;
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(after[i], before[i], bound);
}

TEST(StreamCollide, mass_and_momentum_are_conserved_to_round_off_in_a_periodic_box) {
  expect_conservation<DefaultStress>(6e-8);
  expect_conservation<FloatStress>(6e-8);
  expect_conservation<DoubleStress>(1.1e-16);
  for (const auto eddy : {EddyViscosity::vreman, EddyViscosity::wale, EddyViscosity::smagorinsky})
    expect_conservation<DefaultStress>(6e-8, eddy);
}

/// Populations that arrive at one cell of a periodic box, each taken from the cell it left.
template <class Real, bool third_order>
struct Pulled {
  const std::vector<HermiteSeries<Real, third_order>>& series;
  int x, y, z;
  template <int cx, int cy, int cz>
  Real get() const {
    const int from = (((z - cz) & 15) * lanes + ((y - cy) & 15)) * lanes + ((x - cx) & 15);
    return series[from].template population<cx, cy, cz>();
  }
};

/// The kernel against the definition: collide every cell, move every population to its neighbour, take moments.
template <class S, Collision collision>
void expect_definition(double tolerance) {
  using Real = typename S::Real;
  constexpr bool third_order = collision == Collision::rr;
  PeriodicBlock<S> block(11);
  const double tau = 0.6;
  std::vector<HermiteSeries<Real, third_order>> series;
  for (int cell = 0; cell < amr::block_cells; ++cell) {
    const auto [x, y, z] = amr::cell_at(cell);
    std::array<Real, moments> m;
    for (int i = 0; i < moments; ++i) m[i] = block.get(i, x, y, z);
    series.emplace_back(m, static_cast<Real>(1.0 - 1.0 / tau));
  }
  block.step({tau, 1.0, 0.0}, collision);
  for (int cell = 0; cell < amr::block_cells; ++cell) {
    const auto [x, y, z] = amr::cell_at(cell);
    const auto expected = moments_of<Real>(Pulled<Real, third_order>{series, x, y, z});
    for (int i = 0; i < moments; ++i)
      ASSERT_NEAR(block.get(i, x, y, z), expected[i], tolerance) << i << " at " << x << " " << y << " " << z;
  }
}

TEST(StreamCollide, agrees_with_populations_moved_one_by_one) {
  expect_definition<FloatStress, Collision::rr>(4e-7);
  expect_definition<FloatStress, Collision::bgk>(4e-7);
  expect_definition<DoubleStress, Collision::rr>(1e-15);
  expect_definition<DoubleStress, Collision::bgk>(1e-15);
}

/// Viscosity that damps a shear wave of length 16 along an axis or a diagonal of its plane, less that of the scheme.
double surplus_viscosity(bool diagonal, double tau, double sigma) {
  const double k = 2.0 * std::numbers::pi / lanes, directions = diagonal ? 2.0 : 1.0;
  PeriodicBlock<DoubleStress> block;
  const auto phase = [&](const Index3& at) { return k * (at[0] + (diagonal ? at[1] : 0)); };
  block.fill([&](int m, const Index3& at) {
    if (m == uz) return 1e-3 * std::sin(phase(at));
    const bool sheared = m == pxz || (diagonal && m == pyz);
    return sheared ? -tau / 3.0 * 1e-3 * k * std::cos(phase(at)) : 0.0;
  });
  const auto amplitude = [&] { return std::abs(block.get(uz, 4, 0, 0)); };  // a crest
  const auto run = [&](int steps) {
    for (int i = 0; i < steps; ++i) block.step({tau, sigma, 0.0});
    return amplitude();
  };
  const double before = run(300), after = run(300);
  return std::log(before / after) / (300.0 * directions * k * k) - (tau - 0.5) / 3.0;
}

/// At rest and close to tau = 1/2, to second order: nu k^2 / 12 along an axis and nothing along a diagonal; by the
/// hybrid term (1 - sigma) / (1 + sigma) k^2 / 24 along an axis and half of it along a diagonal (docs/theory.md). What
/// it may be off by is of the next order.
TEST(StreamCollide, viscosity_of_short_waves_is_what_the_theory_says) {
  const double tau = 0.504, nu = (tau - 0.5) / 3.0, k2 = std::pow(2.0 * std::numbers::pi / lanes, 2);
  const double of_hybrid = (1.0 - 0.98) / (1.0 + 0.98) / 24.0 * k2;
  EXPECT_NEAR(surplus_viscosity(false, tau, 1.0), nu * k2 / 12.0, 1e-3 * nu);
  EXPECT_NEAR(surplus_viscosity(true, tau, 1.0), 0.0, 1e-3 * nu);
  EXPECT_NEAR(surplus_viscosity(false, tau, 0.98) - nu * k2 / 12.0, of_hybrid, k2 / 4.0 * of_hybrid);
  EXPECT_NEAR(surplus_viscosity(true, tau, 0.98), of_hybrid, k2 / 4.0 * of_hybrid);
}

/// By how much too slowly, relative to the flow along x that carries it, a shear wave oblique in the x-y plane travels.
double lag_of_a_carried_wave(double tau, Collision collision) {
  const double k = 2.0 * std::numbers::pi / lanes, speed = 0.1;
  const int steps = 320;
  PeriodicBlock<DoubleStress> block;
  block.fill([&](int m, const Index3& at) {
    const double phase = k * (at[0] + at[1]);
    if (m == ux) return speed;
    if (m == uz) return 1e-3 * std::cos(phase);
    return m == pxz || m == pyz ? tau / 3.0 * 1e-3 * k * std::sin(phase) : 0.0;
  });
  for (int i = 0; i < steps; ++i) block.step({tau, 1.0, 0.0}, collision);
  double in_phase = 0.0, quadrature = 0.0;  // with a wave that has kept up
  for (int x = 0; x < lanes; ++x) {
    const double phase = k * (x - speed * steps);
    in_phase += block.get(uz, x, 0, 0) * std::cos(phase);
    quadrature += block.get(uz, x, 0, 0) * std::sin(phase);
  }
  return -std::atan2(quadrature, in_phase) / (k * speed * steps);
}

/// Streaming carries it too slowly by tau (3 - 4 tau) / 6 k_y^2; the hybrid scheme takes that away (docs/theory.md).
TEST(StreamCollide, waves_carried_by_a_flow_keep_up_with_it) {
  const double k2 = std::pow(2.0 * std::numbers::pi / lanes, 2);
  for (const double tau : {0.502, 0.6, 0.7}) {
    const double expected = tau * (3.0 - 4.0 * tau) / 6.0 * k2;
    EXPECT_NEAR(lag_of_a_carried_wave(tau, Collision::rr), expected, 0.05 * k2 / 12.0) << tau;
    EXPECT_NEAR(lag_of_a_carried_wave(tau, Collision::hrr), 0.0, 0.05 * k2 / 12.0) << tau;
  }
}

TEST(StreamCollide, columns_hold_the_cells_at_the_x_faces_and_save_reading_rows) {
  PeriodicBlock<DefaultStress> from_columns(5), from_rows(5);
  from_columns.step({0.52, 0.98, 0.0});
  from_rows.step({0.52, 0.98, 0.0}, Collision::hrr, EddyViscosity::none, false);
  for (int cell = 0; cell < amr::block_cells; ++cell) {
    const auto [x, y, z] = amr::cell_at(cell);
    for (int m = 0; m < moments; ++m) {
      ASSERT_EQ(from_columns.get(m, x, y, z), from_rows.get(m, x, y, z));
      if (x == 0 || x == lanes - 1) {
        ASSERT_EQ(from_columns.column(x > 0, m, y, z), from_columns.get(m, x, y, z));
      }
    }
  }
}

TEST(StreamCollide, a_cell_out_of_bounds_or_not_a_number_is_reported) {
  PeriodicBlock<FloatStress> sound(3);
  sound.step({0.6, 0.98, 0.0});
  EXPECT_FALSE(sound.record.diverged);
  for (const float u : {0.9f, std::nanf("")}) {
    PeriodicBlock<FloatStress> block;
    block.fill([&](int m, const Index3&) { return m == ux ? u : 0.0f; });
    block.step({0.6, 0.98, 0.0});
    EXPECT_TRUE(block.record.diverged);
  }
}

Gradient<double> transposed(const Gradient<double>& g) {
  Gradient<double> t;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) t[a][b] = g[b][a];
  return t;
}

TEST(EddyViscosity, vanishes_where_the_model_says_there_is_no_turbulence) {
  const Gradient<double> shear{{{0, 0, 0}, {0.3, 0, 0}, {0, 0, 0}}};
  const Gradient<double> rotation{{{0, 0.2, 0}, {-0.2, 0, 0}, {0, 0, 0}}};
  EXPECT_LT(eddy_viscosity<EddyViscosity::vreman>(shear, 1.0), 1e-12);
  EXPECT_LT(eddy_viscosity<EddyViscosity::wale>(shear, 1.0), 1e-12);
  EXPECT_NEAR(eddy_viscosity<EddyViscosity::smagorinsky>(shear, 1.0), 0.3, 1e-12);
  EXPECT_EQ(eddy_viscosity<EddyViscosity::smagorinsky>(rotation, 1.0), 0.0);
  for (const Gradient<double>& rest : {Gradient<double>{}}) {
    EXPECT_EQ(eddy_viscosity<EddyViscosity::vreman>(rest, 1.0), 0.0);
    EXPECT_EQ(eddy_viscosity<EddyViscosity::wale>(rest, 1.0), 0.0);
  }
}

// Values by the models' definitions, evaluated by hand for u = (2x + y, -x - y, 3x - z): S = ((2, 0, 1.5), (0, -1, 0),
// (1.5, 0, -1)); beta = g g^T with g_ij = du_i/dx_j; (g^2)_ij = ((3, 1, 0), (-1, 0, 0), (3, 3, 1)).
TEST(EddyViscosity, follows_the_definitions) {
  const Gradient<double> g = transposed({{{2, 1, 0}, {-1, -1, 0}, {3, 0, -1}}});
  EXPECT_NEAR(eddy_viscosity<EddyViscosity::smagorinsky>(g, 0.01), 0.01 * std::sqrt(2 * 10.5), 1e-12);
  // beta = ((5, -3, 6), (-3, 2, -3), (6, -3, 10)), B = (10 - 9) + (50 - 36) + (20 - 9)
  EXPECT_NEAR(eddy_viscosity<EddyViscosity::vreman>(g, 0.07), 0.07 * std::sqrt(26.0 / 17.0), 1e-12);
  // Sd = ((3 - 4/3, 0, 1.5), (0, -4/3, 1.5), (1.5, 1.5, 1 - 4/3))
  const double sd = 25.0 / 9 + 16.0 / 9 + 1.0 / 9 + 4 * 2.25;
  EXPECT_NEAR(eddy_viscosity<EddyViscosity::wale>(g, 0.25),
              0.25 * std::pow(sd, 1.5) / (std::pow(10.5, 2.5) + std::pow(sd, 1.25)), 1e-12);
}

/// In a uniform shear flow whose stress is that of tau + 3 nu_t already, a step changes nothing.
TEST(EddyViscosity, adds_to_the_viscosity_of_the_scheme) {
  const double shear = 2e-3, tau = 0.505, factor = 4.0;
  const double with_eddies = tau + 3.0 * factor * shear;
  const double stored = (1.0 - 1.0 / with_eddies) / (1.0 - 1.0 / tau) * (-with_eddies / 3.0 * shear);
  PeriodicBlock<DoubleStress> block;
  block.fill([&](int m, const Index3& at) { return m == ux ? shear * (at[1] - 7.5) : m == pxy ? stored : 0.0; });
  block.step({tau, 0.9, factor}, Collision::hrr, EddyViscosity::smagorinsky);
  for (int y = 3; y < 13; ++y) {
    EXPECT_NEAR(block.get(ux, 8, y, 8), shear * (y - 7.5), 1e-7);
    EXPECT_NEAR(block.get(pxy, 8, y, 8) / stored, 1.0, 1e-3);
  }
}

}  // namespace
}  // namespace drogue::lbm
