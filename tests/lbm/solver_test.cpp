// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of the whole fluid: exactness on simple flows, convergence, conservation, independence of threads.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "../core/memory_archive.hpp"
#include "core/error.hpp"
#include "fluid/averages.hpp"
#include "lbm/solver.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

fluid::Specification specification(double viscosity, double lattice_velocity) {
  fluid::Specification s;
  s.density = 1.0;
  s.viscosity = viscosity;
  s.reference_velocity = 1.0;
  s.lattice_velocity = lattice_velocity;
  return s;
}

/// A periodic box of `across` coarse cells along x and y, one block deep, edge 1 m; the quarter x, y < 1/2 refined
/// `extra` times.
amr::Forest periodic_box(int across, int extra) {
  const double dx = 1.0 / across;
  const amr::Domain domain{{Vec3::Zero(), Vec3(1.0, 1.0, n * dx)}, dx, {true, true, true}};
  const Box quarter{Vec3(0.01, 0.01, 0.0), Vec3(0.49, 0.49, 1.0)};
  return amr::Forest(domain, extra, amr::refine_box(quarter, dx, dx / (1 << extra)));
}

template <class S>
double taylor_green_error(int across, int extra) {
  auto s = specification(1.0 / 50.0, 0.64 / across);  // diffusive scaling: compressibility falls with the error
  s.initial_velocity = {Expression("sin(2*pi*x)*cos(2*pi*y)"), Expression("-cos(2*pi*x)*sin(2*pi*y)"), Expression(0.0)};
  s.initial_pressure = Expression("0.25*(cos(4*pi*x)+cos(4*pi*y))");
  BasicSolver<S> solver(periodic_box(across, extra), s);
  while (solver.time() < 0.25) solver.step(nullptr);
  const std::string decay = "exp(-0.16*pi^2*t)*";
  return fluid::relative_velocity_error(solver, {Expression(decay + s.initial_velocity[0].text()),
                                                 Expression(decay + s.initial_velocity[1].text()), Expression(0.0)});
}

TEST(Solver, taylor_green_converges_at_second_order_on_one_level) {
  using S = DoubleStress;  // rounding of 16-bit stresses is seen at 64 cells
  const double e16 = taylor_green_error<S>(16, 0), e32 = taylor_green_error<S>(32, 0),
               e64 = taylor_green_error<S>(64, 0);
  std::printf("  one level    16: %.3e  32: %.3e  64: %.3e  order %.2f %.2f\n", e16, e32, e64, std::log2(e16 / e32),
              std::log2(e32 / e64));
  EXPECT_GT(std::log2(e16 / e32), 1.9);
  EXPECT_GT(std::log2(e32 / e64), 1.9);
}

/// A rounding of velocities that is biased by a tenth of the last bit, 6e-9, would make 1e-5 in these 1600 steps.
/// 16-bit stresses, off by 1.4e-4 of themselves (rms), are a noise of some 1.4e-4 (2/3 tau k) / sqrt(2 nu) = 3e-5 of
/// the velocity.
TEST(Solver, storage_changes_a_decaying_vortex_by_rounding_noise_only) {
  const double doubles = taylor_green_error<DoubleStress>(64, 0), floats = taylor_green_error<FloatStress>(64, 0),
               standard = taylor_green_error<DefaultStress>(64, 0);
  std::printf("  error in doubles %.3e  floats %.3e  default %.3e\n", doubles, floats, standard);
  EXPECT_NEAR(floats, doubles, 5e-6);
  EXPECT_NEAR(standard, doubles, 6e-5);
}

TEST(Solver, taylor_green_converges_at_second_order_on_two_levels) {
  const double e32 = taylor_green_error<DefaultStress>(32, 1), e64 = taylor_green_error<DefaultStress>(64, 1);
  std::printf("  two levels   32: %.3e  64: %.3e  order %.2f\n", e32, e64, std::log2(e32 / e64));
  EXPECT_GT(std::log2(e32 / e64), 1.9);
}

/// A tunnel of 4 x 2 x 2 root blocks with a cube refined twice in its middle.
amr::Forest tunnel(double dx = 0.25) {
  const amr::Domain domain{{Vec3::Zero(), Vec3(64 * dx, 32 * dx, 32 * dx)}, dx, {false, false, false}};
  const Vec3 middle = domain.box.upper / 2.0;
  const Box cube{middle - Vec3::Constant(3.0 * dx), middle + Vec3::Constant(3.0 * dx)};
  return amr::Forest(domain, 2, amr::refine_box(cube, dx, dx / 4));
}

fluid::Specification wind_tunnel(double speed) {
  auto s = specification(1e-3, 0.05);
  for (auto& face : s.face) face.type = fluid::Boundary::free_slip;
  s.face[0].type = fluid::Boundary::velocity;
  s.face[0].velocity = {Expression(speed), Expression(0.0), Expression(0.0)};
  s.face[1].type = fluid::Boundary::outlet;
  s.initial_velocity = {Expression(speed), Expression(0.0), Expression(0.0)};
  return s;
}

TEST(Solver, uniform_flow_stays_uniform_through_inlet_outlet_walls_and_levels) {
  Solver solver(tunnel(), wind_tunnel(1.0));
  ASSERT_EQ(solver.forest().levels(), 3);
  for (int i = 0; i < 15; ++i) solver.step(nullptr);
  fluid::BlockFields fields;
  for (int level = 0; level < 3; ++level) {
    const auto leaves = solver.forest().range(level, amr::Kind::leaf);
    for (int id = leaves.begin; id < leaves.end; ++id) {
      solver.read_block(id, fields);
      for (int c = 0; c < amr::block_cells; ++c) {
        ASSERT_NEAR(fields.velocity[0][c], 1.0f, 2e-5f);
        ASSERT_NEAR(fields.velocity[1][c], 0.0f, 2e-5f);
        ASSERT_NEAR(fields.velocity[2][c], 0.0f, 2e-5f);
      }
    }
  }
}

/// Momentum enters a closed periodic box only through the hook: kappa f dt for every opened cell.
class Push : public fluid::FineStepHook {
 public:
  void on_fine_step(fluid::FineStep& step) override {
    const amr::Forest& forest = *step.u_star.forest;
    const auto leaves = forest.range(forest.finest(), amr::Kind::leaf);
    const int block = leaves.begin;
    step.f.open(std::span(&block, 1));
    for (int i = 0; i < fluid::ForceField::block_floats; ++i) step.f.block(block)[i] = 1e-2f;
    impulse += step.dt * 1e-2 * std::pow(forest.spacing(forest.finest()), 3) * amr::block_cells;
    ++calls;
  }
  double impulse = 0.0;
  int calls = 0;
};

TEST(Solver, the_hook_is_called_once_per_finest_step_and_its_impulse_reaches_the_fluid) {
  auto s = specification(1e-2, 0.05);
  s.initial_velocity = {Expression(0.1), Expression(0.0), Expression(0.0)};
  Solver solver(periodic_box(32, 0), s);
  Push push;
  const auto before = solver.mass_and_momentum();
  for (int i = 0; i < 20; ++i) solver.step(&push);
  const auto after = solver.mass_and_momentum();
  EXPECT_EQ(push.calls, 20);
  for (int a = 1; a < 4; ++a) EXPECT_NEAR(after[a] - before[a], push.impulse, 2e-3 * push.impulse);

  Solver refined(periodic_box(32, 1), s);
  Push finest;
  for (int i = 0; i < 3; ++i) refined.step(&finest);
  EXPECT_EQ(finest.calls, 6);
}

TEST(Solver, mass_is_conserved_to_round_off_between_parallel_no_slip_walls_and_in_a_free_slip_box) {
  for (const bool slip : {false, true}) {
    auto s = specification(1e-2, 0.05);
    for (auto& face : s.face) face.type = fluid::Boundary::free_slip;
    if (!slip) s.face[2].type = s.face[3].type = fluid::Boundary::no_slip;
    s.initial_velocity = {Expression("sin(2*pi*x)*sin(pi*y)"), Expression("sin(pi*y)*cos(2*pi*x)"), Expression(0.0)};
    const double dx = 1.0 / 32;
    const std::array<bool, 3> periodic{!slip, false, false};
    Solver solver(amr::Forest({{Vec3::Zero(), Vec3(1.0, 1.0, 16 * dx)}, dx, periodic}, 0, amr::any_of({})), s);
    const auto before = solver.mass_and_momentum();
    for (int i = 0; i < 400; ++i) solver.step(nullptr);
    EXPECT_NEAR(solver.mass_and_momentum()[0] / before[0], 1.0, 2e-7);
  }
}

/// Couette flow between a wall at rest and one that moves: linear, exactly, with the walls half-way between cells.
TEST(Solver, couette_flow_is_linear_between_walls_placed_at_the_faces) {
  auto s = specification(0.2, 0.05);
  s.face[2].type = s.face[3].type = fluid::Boundary::no_slip;
  s.face[3].velocity = {Expression(1.0), Expression(0.0), Expression(0.0)};
  const double dx = 1.0 / 16;
  Solver solver(amr::Forest({{Vec3::Zero(), Vec3::Ones()}, dx, {true, false, true}}, 0, amr::any_of({})), s);
  while (solver.time() < 6.0) solver.step(nullptr);
  fluid::BlockFields fields;
  solver.read_block(0, fields);
  for (int y = 0; y < n; ++y) EXPECT_NEAR(fields.velocity[0][y * n + 3], (y + 0.5) * dx, 2e-3);
}

TEST(Solver, a_formula_inlet_ramps_up_and_varies_in_place_and_time) {
  auto s = wind_tunnel(0.0);
  s.face[0].velocity = {Expression("y/8*(1+0.1*t)"), Expression(0.0), Expression(0.0)};
  s.face[0].ramp = 0.5;
  Solver solver(tunnel(), s);
  while (solver.time() < 1.0) solver.step(nullptr);
  fluid::BlockFields fields;
  solver.read_block(solver.forest().locate(Vec3(0.1, 0.1, 4.0))->block, fields);
  const float low = fields.velocity[0][0];
  solver.read_block(solver.forest().locate(Vec3(0.1, 7.9, 4.0))->block, fields);
  const float high = fields.velocity[0][15 * n];
  EXPECT_GT(high, low + 0.5f);
}

/// A pressure pulse that runs into the outlet: with a sponge less of it comes back, and uniform flow is left alone.
TEST(Solver, a_sponge_absorbs_sound_and_leaves_uniform_flow_alone) {
  std::array<double, 2> left;
  for (const bool sponge : {false, true}) {
    auto s = wind_tunnel(1.0);
    s.face[1].sponge = sponge ? 4.0 : 0.0;
    s.initial_pressure = Expression("2*exp(-(x-10)^2)");
    const double dx = 0.25;
    Solver solver(amr::Forest({{Vec3::Zero(), Vec3(64 * dx, 16 * dx, 16 * dx)}, dx, {}}, 0, amr::any_of({})), s);
    while (solver.time() < 1.0) solver.step(nullptr);  // its front half to the outlet and back to the middle
    fluid::BlockFields fields;
    solver.read_block(solver.forest().locate(Vec3(10.0, 2.0, 2.0))->block, fields);
    left[sponge] = 0.0;
    for (const float p : fields.pressure) left[sponge] = std::max(left[sponge], std::abs(double{p}));

    s.initial_pressure.reset();
    Solver quiet(amr::Forest({{Vec3::Zero(), Vec3(64 * dx, 16 * dx, 16 * dx)}, dx, {}}, 0, amr::any_of({})), s);
    for (int i = 0; i < 20; ++i) quiet.step(nullptr);
    quiet.read_block(3, fields);
    for (const float u : fields.velocity[0]) ASSERT_NEAR(u, 1.0f, 2e-5f);
  }
  std::printf("  largest pressure left: %.3f Pa without, %.3f Pa with a sponge\n", left[0], left[1]);
  EXPECT_LT(left[1], 0.2 * left[0]);
}

/// Velocity and pressure of all leaves.
std::vector<float> values_of(const Solver& solver) {
  std::vector<float> values;
  fluid::BlockFields fields;
  for (int level = 0; level < solver.forest().levels(); ++level) {
    const auto leaves = solver.forest().range(level, amr::Kind::leaf);
    for (int id = leaves.begin; id < leaves.end; ++id) {
      solver.read_block(id, fields);
      for (const auto& component : fields.velocity) values.insert(values.end(), component.begin(), component.end());
      values.insert(values.end(), fields.pressure.begin(), fields.pressure.end());
    }
  }
  return values;
}

/// Everything that might remember: levels, an inflow that varies in place and time and rises, a sponge, a hook; saved
/// after an odd number of steps, continued with another number of threads.
TEST(Solver, a_restored_state_goes_on_with_the_same_bits) {
  auto s = wind_tunnel(1.0);
  s.face[0].velocity[1] = Expression("0.1*sin(y)*cos(9*t)");
  s.face[0].ramp = 0.3;
  s.face[1].sponge = 3.0;
  s.initial_velocity[1] = Expression("0.3*sin(x)*cos(2*z)");
  const int threads_before = omp_get_max_threads();
  Push push;
  Solver whole(tunnel(), s), continued(tunnel(), s);
  for (int i = 0; i < 3; ++i) whole.step(&push);
  testing::copy_state(whole, continued);
  EXPECT_EQ(continued.time(), whole.time());
  EXPECT_EQ(values_of(continued), values_of(whole));
  for (int i = 0; i < 4; ++i) whole.step(&push);
  omp_set_num_threads(1 + threads_before % 2);
  for (int i = 0; i < 4; ++i) continued.step(&push);
  omp_set_num_threads(threads_before);
  EXPECT_EQ(continued.time(), whole.time());
  EXPECT_EQ(values_of(continued), values_of(whole));
  EXPECT_EQ(continued.statistics().cell_updates, whole.statistics().cell_updates);
  EXPECT_EQ(continued.statistics().max_mach, whole.statistics().max_mach);
}

TEST(Solver, gives_the_same_bits_for_any_number_of_threads) {
  std::vector<float> reference;
  for (const int threads : {1, 2, 4}) {
    omp_set_num_threads(threads);
    auto s = wind_tunnel(1.0);
    s.initial_velocity[1] = Expression("0.3*sin(x)*cos(2*z)");
    Solver solver(tunnel(), s);
    for (int i = 0; i < 3; ++i) solver.step(nullptr);
    const std::vector<float> values = values_of(solver);
    if (reference.empty()) reference = values;
    EXPECT_EQ(values, reference) << threads << " threads";
  }
}

TEST(Solver, divergence_names_time_level_cell_and_position) {
  auto s = wind_tunnel(1.0);
  s.initial_velocity[0] = Expression("9*exp(-(x-8)^2)");
  Solver solver(tunnel(), s);
  try {
    for (int i = 0; i < 10; ++i) solver.step(nullptr);
    FAIL() << "did not diverge";
  } catch (const Diverged& e) {
    const std::string message = e.what();
    for (const char* part : {"time", "level", "cell", "position"})
      EXPECT_NE(message.find(part), std::string::npos) << message;
    // of 0.45 cells a step and more, where 0.05 are 1 m/s
    const std::size_t speed = message.find("speed ");
    ASSERT_NE(speed, std::string::npos) << message;
    EXPECT_GE(std::stod(message.substr(speed + 6)), 8.9) << message;
  }
}

/// Relative error of the flow between walls at y = 0 and 1 that a force drives; the lower half refined `extra` times.
double channel_error(int across, int extra) {
  const double dx = 1.0 / across;
  const amr::Domain domain{{Vec3::Zero(), Vec3(n * dx, 1.0, n * dx)}, dx, {true, false, true}};
  const Box lower{Vec3(0.0, 0.0, 0.0), Vec3(1.0, 0.49, 1.0)};
  auto s = specification(0.1, 3.2 / across);  // diffusive scaling: so does the slip of the walls
  s.force = {Expression(0.8), Expression(0.0), Expression(0.0)};
  s.face[2].type = s.face[3].type = fluid::Boundary::no_slip;
  s.initial_velocity = {Expression("4*y*(1-y)"), Expression(0.0), Expression(0.0)};
  Solver solver({domain, extra, amr::refine_box(lower, dx, dx / (1 << extra))}, s);
  while (solver.time() < 1.0) solver.step(nullptr);
  return fluid::relative_velocity_error(solver, s.initial_velocity);
}

TEST(Solver, flow_driven_by_a_force_converges_at_second_order) {
  for (const int extra : {0, 1}) {
    const double e32 = channel_error(32, extra), e64 = channel_error(64, extra);
    std::printf("  %d levels   32: %.3e  64: %.3e  order %.2f\n", extra + 1, e32, e64, std::log2(e32 / e64));
    EXPECT_GT(std::log2(e32 / e64), 1.9);
  }
}

TEST(Solver, a_force_that_varies_in_time_gives_its_impulse) {
  auto s = specification(0.01, 0.1);
  s.density = 2.0;
  s.force = {Expression("sin(3*t)"), Expression(0.0), Expression("1-t")};
  BasicSolver<DoubleStress> solver(periodic_box(32, 1), s);
  while (solver.time() < 0.5) solver.step(nullptr);
  const double t = solver.time(), volume = 0.5;
  EXPECT_NEAR(solver.mass_and_momentum()[1], volume * (1.0 - std::cos(3.0 * t)) / 3.0, 1e-5);
  EXPECT_NEAR(solver.mass_and_momentum()[3], volume * (t - 0.5 * t * t), 1e-5);
  fluid::BlockFields fields;
  for (int level = 0; level < 2; ++level) {
    solver.read_block(solver.forest().range(level, amr::Kind::leaf).begin, fields);
    EXPECT_NEAR(fields.velocity[0][0], (1.0 - std::cos(3.0 * t)) / 6.0, 1e-5) << "alike on both levels";
  }
}

}  // namespace
}  // namespace drogue::lbm
