// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium: two methods that share nothing but the forces agree, and what has none is named.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

#include "bodies.hpp"
#include "core/error.hpp"

namespace drogue::fem {
namespace {

const NeoHookean neo_hookean(1e3, 0.3, 0.3);
const PlaneSaintVenantKirchhoff plane_saint_venant_kirchhoff{SaintVenantKirchhoff(1e6, 0.3)};

Mesh square(int elements) {
  return make_sheet({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, {elements, elements}});
}

Model sheet(const MembraneMaterial& material, std::vector<Hold> holds) {
  Model model{square(6), {{"", 1000.0, Membrane{material, 1e-3}}}, {}, {}};
  model.loads.holds = std::move(holds);
  return model;
}

Model hanging_cable() {
  Mesh mesh;
  const int first = add_point(mesh, "first", Vec3::Zero()), last = add_point(mesh, "last", Vec3(1, 0, 0));
  add_line(mesh, "cable", first, last, 20);
  Model model{mesh, {{"", 1000.0, Cable{{1e8, true}, 1e-6, 1.2}}}, {}, {}};
  model.loads.holds = {{.nodes = {first, last}, .rigid = true}};
  model.loads.gravity = Vec3(0, 0, -9.81);
  return model;
}

/// Flat, with pressure on it and its edge held.
Model inflated_sheet() {
  Model model = sheet(plane_saint_venant_kirchhoff, {{.nodes = nodes_named(square(6), "rim"), .rigid = true}});
  model.loads.pressures = {{"", Expression(1e3)}};
  return model;
}

/// Two of its edges are free, where the pressure's tangent is not symmetric.
Model inflated_strip() {
  Model model = sheet(plane_saint_venant_kirchhoff, {{.nodes = nodes_named(square(6), "x_min"), .rigid = true},
                                                     {.nodes = nodes_named(square(6), "x_max"), .rigid = true}});
  model.loads.pressures = {{"", Expression(300.0)}};
  return model;
}

/// A tension field: sheared by its upper edge, which moves by a tenth.
Model sheared_sheet() {
  Model model = sheet(TensionField<PlaneSaintVenantKirchhoff>{plane_saint_venant_kirchhoff},
                      {{.nodes = nodes_named(square(6), "y_min"), .rigid = true},
                       {.nodes = nodes_named(square(6), "y_max"),
                        .rigid = true,
                        .displacement = {Expression("0.1*t"), Expression("0.02*t"), Expression(0.0)}}});
  return model;
}

/// A block on tethers that pulls itself together, with a load on its end.
Model tethered_block() {
  const Mesh mesh = block({0.3, 0.1, 0.1}, {6, 2, 2});
  Model model = one_solid(mesh, neo_hookean, 1.0, {{.nodes = nodes_named(mesh, "x_min"), .stiffness = 1e7}});
  model.loads.forces = {{nodes_named(mesh, "x_max"), {Expression(0.0), Expression(0.2), Expression(0.1)}}};
  model.regions[0].active = {Expression(100.0), Vec3::UnitX()};
  return model;
}

std::vector<Vec3> equilibrium(Model model, Equilibrium method, double tolerance) {
  Structure body(std::move(model));
  body.find_equilibrium(1.0, {.method = method, .tolerance = tolerance});
  return {body.position().begin(), body.position().end()};
}

TEST(Equilibrium, newton_and_relaxation_agree) {
  struct Sample {
    std::string name;
    Model model;
  };
  const std::vector<Sample> samples{{"hanging cable", hanging_cable()},
                                    {"inflated sheet", inflated_sheet()},
                                    {"inflated strip", inflated_strip()},
                                    {"sheared tension field", sheared_sheet()},
                                    {"tethered block", tethered_block()}};
  for (const auto& [name, model] : samples) {
    const auto relaxed = equilibrium(model, Equilibrium::relaxation, 1e-8);
    const auto balanced = equilibrium(model, Equilibrium::newton, 1e-8);
    double apart = 0.0, moved = 0.0;
    for (std::size_t i = 0; i < relaxed.size(); ++i) {
      apart = std::max(apart, (relaxed[i] - balanced[i]).norm());
      moved = std::max(moved, (relaxed[i] - model.mesh.nodes[i]).norm());
    }
    std::printf("%-22s moved by %.3g m, apart by %.2g m\n", name.c_str(), moved, apart);
    EXPECT_LT(apart, 1e-5 * moved) << name;
  }
}

TEST(Equilibrium, every_number_of_threads_gives_the_same_bits_and_choice) {
  const int threads_before = omp_get_max_threads();
  const Mesh mesh = block({0.4, 0.4, 0.1}, {16, 16, 2});
  Model model = one_solid(mesh, neo_hookean, 1.0, {{.nodes = nodes_named(mesh, "x_min"), .rigid = true}});
  model.loads.gravity = Vec3(0, 0, -100.0);
  model.options.integrator = Integrator::cheaper;
  omp_set_num_threads(1);
  const auto reference = equilibrium(model, Equilibrium::newton, 1e-6);
  const Structure alone(model);
  omp_set_num_threads(2);
  EXPECT_EQ(equilibrium(model, Equilibrium::newton, 1e-6), reference);
  const Structure together(model);
  EXPECT_EQ(together.cheaper_equilibrium(), alone.cheaper_equilibrium());
  for (const double dt : {1e-4, 1e-2, 1.0}) EXPECT_EQ(together.integrator_for(dt), alone.integrator_for(dt));
  omp_set_num_threads(threads_before);
}

template <class Error>
std::string failure(Model model, Equilibrium method) {
  Structure body(std::move(model));
  try {
    body.find_equilibrium(0.0, {.method = method, .most_iterations = 2000});
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(Equilibrium, loads_on_a_part_that_nothing_holds_are_named) {
  Model loose = hanging_cable();
  loose.loads.holds[0].axes = {true, true, false};
  Model two_parts = hanging_cable();
  const int a = add_point(two_parts.mesh, "a", Vec3(0, 1, 0)), b = add_point(two_parts.mesh, "b", Vec3(0, 2, 0));
  add_line(two_parts.mesh, "other", a, b, 1);
  for (const Equilibrium method : {Equilibrium::relaxation, Equilibrium::newton}) {
    EXPECT_EQ(
        failure<InputError>(loose, method),
        "nothing holds the part of the structure with node 0 at (0, 0, 0) m along z, and loads of -0.01177 N push "
        "it that way; expected a hold");
    const std::string message = failure<InputError>(two_parts, method);
    EXPECT_NE(message.find("with node 21 at (0, 1, 0) m along z"), std::string::npos) << message;
  }
}

TEST(Equilibrium, a_body_that_turns_for_ever_has_none) {
  // Held at one corner and blown from one side.
  Model model = sheet(plane_saint_venant_kirchhoff, {{.nodes = {0}, .rigid = true}});
  model.loads.pressures = {{"", Expression(1.0)}};
  for (const Equilibrium method : {Equilibrium::relaxation, Equilibrium::newton}) {
    const std::string message = failure<Diverged>(model, method);
    EXPECT_NE(message.find("no equilibrium of the structure was found at t = 0 s"), std::string::npos) << message;
  }
}

TEST(Equilibrium, a_mechanism_without_a_load_is_told) {
  Mesh mesh;
  const int first = add_point(mesh, "first", Vec3::Zero()), last = add_point(mesh, "last", Vec3(1, 0, 0));
  add_line(mesh, "bars", first, last, 2);
  Model model{mesh, {{"", 1000.0, Cable{{1e6, false}, 1e-6}}}, {}, {}};
  model.loads.holds = {{.nodes = {first, last}, .rigid = true}};
  Structure bars(model);
  bars.find_equilibrium(0.0, {.method = Equilibrium::newton});
  EXPECT_NE(bars.free_motion().find("nothing resists a motion of node 2 at (0.5, 0, 0) m"), std::string::npos)
      << bars.free_motion();
  Structure held(hanging_cable());
  held.find_equilibrium(0.0, {.method = Equilibrium::newton});
  EXPECT_EQ(held.free_motion(), "");
}

}  // namespace
}  // namespace drogue::fem
