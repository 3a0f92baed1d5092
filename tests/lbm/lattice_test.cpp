// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of the D3Q19 series and of one block's step.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "lbm/d3q19.hpp"
#include "lbm/stream_collide.hpp"

namespace drogue::lbm {
namespace {

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

  explicit PeriodicBlock(unsigned seed) : field_{MomentField<S>(1), MomentField<S>(1)} {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> u(-0.02f, 0.02f), p(-1e-4f, 1e-4f);
    for (int r = 0; r < rows_per_block; ++r)
      for (int m = 0; m < moments; ++m)
        for (int x = 0; x < lanes; ++x)
          Layout::put(field_[0].block(0) + r * Layout::bytes, m, x, m < 4 ? u(generator) : p(generator));
  }

  void step(const Relaxation& relaxation) {
    BlockNeighbourhood<S> blocks;
    blocks.source.fill(field_[now_].block(0));
    blocks.target = field_[1 - now_].block(0);
    record = stream_collide(blocks, relaxation);
    now_ = 1 - now_;
  }

  float get(int m, int x, int y, int z) const { return Layout::get(field_[now_].row(0, y, z), m, x); }

  std::array<double, 4> totals() const {
    std::array<double, 4> sum{};
    for (int z = 0; z < lanes; ++z)
      for (int y = 0; y < lanes; ++y)
        for (int x = 0; x < lanes; ++x) {
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

template <class S>
void expect_conservation() {
  PeriodicBlock<S> block(7);
  const auto before = block.totals();
  constexpr int steps = 50;
  for (int i = 0; i < steps; ++i) block.step({0.51f, 0.98f});
  const auto after = block.totals();
  // round-off of a float per cell and step, as a random walk over cells and steps
  const double bound = 6e-8 * 0.02 * std::sqrt(4096.0 * steps) * 8;
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(after[i], before[i], bound);
}

TEST(StreamCollide, mass_and_momentum_are_conserved_to_round_off_in_a_periodic_box) {
  expect_conservation<DefaultStress>();
  expect_conservation<FloatStress>();
}

/// Populations that arrive at one cell of a periodic box, each taken from the cell it left.
struct Pulled {
  const std::vector<HermiteSeries<float>>& series;
  int x, y, z;
  template <int cx, int cy, int cz>
  float get() const {
    const int from = (((z - cz) & 15) * lanes + ((y - cy) & 15)) * lanes + ((x - cx) & 15);
    return series[from].population<cx, cy, cz>();
  }
};

/// The kernel against the definition: collide every cell, move every population to its neighbour, take moments.
TEST(StreamCollide, agrees_with_populations_moved_one_by_one) {
  PeriodicBlock<FloatStress> block(11);
  const float tau = 0.6f, keep = 1.0f - 1.0f / tau;
  std::vector<HermiteSeries<float>> series;
  for (int z = 0; z < lanes; ++z)
    for (int y = 0; y < lanes; ++y)
      for (int x = 0; x < lanes; ++x) {
        Moments m;
        for (int i = 0; i < moments; ++i) m[i] = block.get(i, x, y, z);
        series.emplace_back(m, keep);
      }
  block.step({tau, 1.0f});
  for (int z = 0; z < lanes; ++z)
    for (int y = 0; y < lanes; ++y)
      for (int x = 0; x < lanes; ++x) {
        const Moments expected = moments_of<float>(Pulled{series, x, y, z});
        for (int i = 0; i < moments; ++i)
          ASSERT_NEAR(block.get(i, x, y, z), expected[i], 4e-7f) << i << " at " << x << " " << y << " " << z;
      }
}

TEST(StreamCollide, a_cell_out_of_bounds_or_not_a_number_is_reported) {
  PeriodicBlock<FloatStress> sound(3);
  sound.step({0.6f, 0.98f});
  EXPECT_FALSE(sound.record.diverged);
  for (const float u : {0.9f, std::nanf("")}) {
    MomentField<FloatStress> from(1), to(1);
    for (int r = 0; r < rows_per_block; ++r)
      RowLayout<FloatStress>::store(from.block(0) + r * RowLayout<FloatStress>::bytes, ux, broadcast(u));
    BlockNeighbourhood<FloatStress> blocks;
    blocks.source.fill(from.block(0));
    blocks.target = to.block(0);
    EXPECT_TRUE(stream_collide(blocks, {0.6f, 0.98f}).diverged);
  }
}

}  // namespace
}  // namespace drogue::lbm
