// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bodies.hpp"
#include "core/error.hpp"

namespace drogue::fsi {
namespace {

using namespace drogue::testing;

constexpr double spacing = 1.0 / 16, dt = 1e-3;
const Vec3 centre(1.02, 0.49, 0.51);

class Peskin : public OnOneThread {
 protected:
  static fem::Structure solid(std::vector<fem::Hold> holds = {}) {
    return plate({.thickness = 0.02, .elements = 8, .holds = std::move(holds)}, centre);
  }
  static CouplingOptions options() {
    CouplingOptions peskin = coupled();
    peskin.scheme = Scheme::peskin;
    return peskin;
  }

  const amr::Forest forest_ = periodic_box();
  FakeFluid fluid_{forest_, fluid_density};
};

TEST_F(Peskin, a_stress_free_solid_moves_with_the_fluid_and_leaves_it_alone) {
  const Vec3 u(1.0, 0.5, -0.25);  // exact in float
  fluid_.fill([&](const Vec3&) { return u; });
  fem::Structure body = solid();
  Coupling coupling(body, forest_, options());
  for (int step = 0; step < 5; ++step) fluid_.step(coupling, dt);
  for (std::size_t node = 0; node < body.position().size(); ++node) {
    EXPECT_LT((body.position()[node] - body.mesh().nodes[node] - 5 * dt * u).norm(), 1e-9);
  }
  EXPECT_LT(coupling.last().force.norm(), 1e-9);
  EXPECT_LT(coupling.slip(fluid_.view())[1], 1e-6);
}

TEST_F(Peskin, a_free_solid_puts_no_net_force_on_the_fluid) {
  fluid_.fill_at_random(51);
  fem::Structure body = solid();
  Coupling coupling(body, forest_, options());
  const Vec3 before = fluid_.momentum();
  for (int step = 0; step < 50; ++step) fluid_.step(coupling, dt);
  EXPECT_LT((fluid_.momentum() - before).norm(), 1e-6);
  EXPECT_LT(coupling.last().force.norm(), 1e-12);
}

TEST_F(Peskin, a_tethered_solid_stops_the_fluid_that_pulls_it_and_feels_its_drag) {
  fluid_.fill([](const Vec3&) { return Vec3(0.2, 0, 0); });
  fem::Structure body = solid({{.nodes = all_nodes(8), .stiffness = 2e3, .damping = 20.0}});
  Coupling coupling(body, forest_, options());
  for (int step = 0; step < 10; ++step) {
    const Vec3 before = fluid_.momentum();
    fluid_.step(coupling, dt);
    EXPECT_LT((fluid_.momentum() - before + dt * coupling.last().force).norm(), 1e-7);
  }
  EXPECT_GT(coupling.last().force.x(), 0.0);
  double fastest = 0.0;
  for (int step = 0; step < 3000; ++step) {
    fluid_.step(coupling, dt);
    fastest = std::max(fastest, largest_speed(body));
  }
  EXPECT_LT(fastest, 0.3);
}

TEST_F(Peskin, rigidly_held_nodes_stay_and_bring_the_fluid_to_rest) {
  fluid_.fill([](const Vec3&) { return Vec3(0.5, 0, 0); });
  fem::Structure body = solid({{.nodes = all_nodes(8), .rigid = true}});
  Coupling coupling(body, forest_, options());
  fluid_.step(coupling, dt);
  // The same as with the added-mass scheme, but for the two faces being two markers.
  const double drag = fluid_density * 0.25 * spacing * 8.0 / 3.0 * 0.5 / dt;
  EXPECT_NEAR(coupling.last().force.x(), drag, 1e-6 * drag);
  EXPECT_TRUE(std::ranges::equal(body.position(), body.mesh().nodes));
  EXPECT_EQ(largest_speed(body), 0.0);
}

TEST(PeskinDensity, a_solid_of_another_density_is_rejected) {
  const amr::Forest forest = periodic_box();
  fem::Structure body = plate({.density = 1.1 * fluid_density});
  CouplingOptions options = coupled();
  options.scheme = Scheme::peskin;
  try {
    Coupling coupling(body, forest, options);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(
        std::string(error.what()),
        "body 'plate': the peskin scheme has no inertia of the solid, so its density must be the fluid's, 1.2 kg/m^3, "
        "but is 1.32; change it, or use the added_mass scheme");
  }
}

}  // namespace
}  // namespace drogue::fsi
