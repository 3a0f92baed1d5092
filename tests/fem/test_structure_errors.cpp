// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "bodies.hpp"
#include "core/error.hpp"

namespace drogue::fem {
namespace {

const NeoHookean neo_hookean(1e3, 0.3, 0.3);

template <class Error>
std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

void expect_message(const std::function<void()>& action, const std::string& part) {
  const std::string message = message_of<InputError>(action);
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

Mesh bar() { return block({3.0, 1.0, 1.0}, {3, 1, 1}); }

TEST(StructureErrors, bad_meshes_are_named) {
  const auto build = [](const Mesh& mesh) { solid(mesh, neo_hookean, {.density = 1.0}, {}); };
  Mesh inverted = bar();
  std::swap(inverted.hexahedra[1][0], inverted.hexahedra[1][1]);
  expect_message([&] { build(inverted); }, "hexahedron 1 near (");
  Mesh mirrored = bar();
  for (Vec3& p : mirrored.nodes) p.y() = -p.y();
  expect_message([&] { build(mirrored); }, "hexahedron 0 near (-1.5, 0.5, -0.5) m is flat or inverted");
  Mesh loose = bar();
  loose.nodes.emplace_back(5.0, 6.0, 7.0);
  expect_message([&] { build(loose); }, "node 16 at (5, 6, 7) m is unconnected");
  Mesh beyond = bar();
  beyond.hexahedra[2][7] = 99;
  expect_message([&] { build(beyond); }, "hexahedron 2 names node 99; expected 0 to 15");
  expect_message([&] { build(Mesh{}); }, "the mesh is empty");
}

TEST(StructureErrors, bad_options_are_named) {
  const auto build = [](const SolidOptions& options) { solid(bar(), neo_hookean, options, {}); };
  expect_message([&] { build({.density = -1.0}); }, "the density of the mesh is -1 kg/m^3; expected a positive number");
  expect_message([&] { build({.density = 1.0, .dissipation = 0.5}); }, "dissipation is 0.5");
  expect_message([&] { build({.density = 1.0, .safety = 1.5}); }, "safety of the structure's stable step is 1.5");
  expect_message([&] { build({.density = 1.0, .volume_ratio = {1.2, 3.0}}); }, "volume ratio are 1.2 and 3");
}

TEST(StructureErrors, bad_holds_are_named) {
  const auto build = [](std::vector<Hold> holds) { solid(bar(), neo_hookean, {.density = 1.0}, std::move(holds)); };
  expect_message([&] { build({{{0, 1, 77}, true}}); }, "a hold names node 77; expected 0 to 15");
  expect_message([&] { build({{{0, 1}, true}, {{1, 2}, false, 1.0}}); }, "node 1 belongs to two holds along x");
  expect_message([&] { build({{{0}, false, -1.0, 0.0}}); }, "a hold has stiffness -1 N/m^4");
}

TEST(StructureErrors, bad_inertia_is_named) {
  const Mesh mesh = block({1.0, 1.0, 0.1}, {2, 2, 1});
  Structure plate = solid(mesh, neo_hookean, {.density = 1.0}, {{{3}, true}});
  Inertia inertia = plate.inertia();
  inertia.mass[4] = 0.0;
  expect_message([&] { plate.set_inertia(inertia); }, "point 4 (node 4) has mass 0 kg; expected a positive number");
  inertia.mass.pop_back();
  expect_message([&] { plate.set_inertia(inertia); }, "18 points and 17 masses");
  inertia = plate.inertia();
  inertia.point[0] = {1, -1};
  expect_message([&] { plate.set_inertia(inertia); }, "node 0 belongs to 0 points");
  inertia.point[0] = {0, 40};
  expect_message([&] { plate.set_inertia(inertia); }, "point 0 joins nodes 0 and 40");
  expect_message([&] { plate.set_inertia(paired(plate, 1.0)); },
                 "nodes 3 and 12 face each other but are not held alike");
}

TEST(StructureErrors, resets_of_velocity_ask_for_dissipation) {
  Structure body = solid(bar(), neo_hookean, {.density = 1.0, .dissipation = 1e-5}, {});
  Inertia inertia = body.inertia();
  inertia.reset = 0.0;
  body.set_inertia(inertia);
  expect_message([&] { body.advance(1e-4, 0.0); }, "a dissipation of 1e-05 would take 25001 sub-steps");
}

TEST(StructureErrors, a_hinge_needs_a_pair_and_explicit_motion) {
  const Hold hinge{.nodes = {3}, .rigid = true, .hinged = true};
  Structure plate = solid(block({1.0, 1.0, 0.1}, {2, 2, 1}), neo_hookean, {.density = 1.0}, {hinge});
  expect_message([&] { plate.set_inertia(plate.inertia()); }, "node 3 is held by a hinge, but faces no other node");
  Model model = one_solid(block({1.0, 1.0, 0.1}, {2, 2, 1}), neo_hookean, 1.0, {hinge});
  model.options.integrator = Integrator::implicit_scheme;
  expect_message([&] { Structure{model}; }, "implicit motion knows no hinged hold");
}

TEST(StructureErrors, an_inverted_element_is_named_with_place_and_time) {
  Structure body = solid(bar(), neo_hookean, {.density = 1.0}, {});
  auto x = body.mesh().nodes;
  // The last face moves through the one before it.
  for (Vec3& p : x) {
    if (p.x() > 1.4) p.x() -= 1.2;
  }
  body.set_state(x, std::vector<Vec3>(x.size(), Vec3::Zero()));
  EXPECT_EQ(message_of<Diverged>([&] { body.advance(1e-4, 2.5); }),
            "the structure is torn or inverted in hexahedron 2 (J = -0.2, expected 0.05 to 20) near (0.4, 0, 0) m at t "
            "= 2.5 s");
}

TEST(StructureErrors, a_position_that_is_not_finite_is_named) {
  Structure body = solid(bar(), neo_hookean, {.density = 1.0}, {});
  auto x = body.mesh().nodes;
  x[0].y() = std::numeric_limits<double>::quiet_NaN();
  body.set_state(x, std::vector<Vec3>(x.size(), Vec3::Zero()));
  const std::string message = message_of<Diverged>([&] { body.advance(1e-4, 0.0); });
  EXPECT_NE(message.find("in hexahedron 0 (J = nan, expected 0.05 to 20) near (-1, 0, 0) m"), std::string::npos)
      << message;
}

TEST(StructureErrors, a_collapse_during_a_step_is_dated_within_it) {
  Structure body = solid(bar(), SaintVenantKirchhoff(1e3, 0.3), {.density = 1.0}, {});
  auto v = std::vector<Vec3>(body.mesh().nodes.size(), Vec3::Zero());
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (body.mesh().nodes[i].x() > 1.4) v[i].x() = -500.0;
  }
  body.set_state(body.mesh().nodes, v);
  const std::string message = message_of<Diverged>([&] { body.advance(0.1, 1.0); });
  EXPECT_NE(message.find("hexahedron 2 (J = "), std::string::npos) << message;
  EXPECT_NE(message.find("m at t = 1.0"), std::string::npos) << message;
}

}  // namespace
}  // namespace drogue::fem
