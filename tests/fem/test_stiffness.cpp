// SPDX-License-Identifier: GPL-3.0-or-later
// The tangent of every element, load and law is the derivative of its forces.
#include <gtest/gtest.h>

#include <cmath>

#include "bodies.hpp"
#include "fem/stiffness.hpp"

namespace drogue::fem {
namespace {

struct Sample {
  std::string name;
  Mesh mesh;
  Region region;
  std::vector<Pressure> pressures{};
  double amplitude = 0.02;  ///< of the random displacements [m]
};

Mesh sheet() { return make_sheet({{Vec3(0, 0, 0), Vec3(0.4, 0.05, 0), Vec3(0.5, 0.4, 0.1), Vec3(0, 0.3, 0)}, {3, 3}}); }

Mesh triangles() {
  Mesh mesh = sheet();
  for (const auto& [a, b, c, d] : mesh.quadrilaterals) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  mesh.quadrilaterals.clear();
  return mesh;
}

Mesh line() {
  Mesh mesh;
  add_line(mesh, "line", add_point(mesh, "a", Vec3(0, 0, 0)), add_point(mesh, "b", Vec3(1, 0.5, 0.2)), 9);
  return mesh;
}

const NeoHookean neo_hookean(1e3, 0.3, 0.4);
const SaintVenantKirchhoff saint_venant_kirchhoff(1e3, 0.3);
const PlaneNeoHookean plane_neo_hookean{neo_hookean};
const PlaneSaintVenantKirchhoff plane_saint_venant_kirchhoff{saint_venant_kirchhoff};

std::vector<Sample> samples() {
  const Mesh solid = block({0.3, 0.2, 0.2}, {3, 2, 2});
  std::vector<Sample> all;
  for (const double tension : {0.0, 300.0}) {
    const ActiveStress active{Expression(tension), Vec3(1, 2, 2).normalized()};
    const std::string suffix = tension == 0.0 ? "" : ", active";
    const auto add = [&](const std::string& name, const Mesh& mesh, const auto& kind) {
      all.push_back({name + suffix, mesh, {"", 1.0, kind, active}});
    };
    for (const auto& [name, element] : hexahedra) {
      add("neo-Hookean hexahedra, " + name, solid, Solid{neo_hookean, element});
      add("Saint Venant-Kirchhoff hexahedra, " + name, solid, Solid{saint_venant_kirchhoff, element});
    }
    for (const auto& [name, mesh] : {std::pair{"quadrilaterals", sheet()}, std::pair{"triangles", triangles()}}) {
      const std::string of = name;
      add("neo-Hookean " + of, mesh, Membrane{plane_neo_hookean, 0.1});
      add("Saint Venant-Kirchhoff " + of, mesh, Membrane{plane_saint_venant_kirchhoff, 0.1});
      add("fabric " + of, mesh, Membrane{OrthotropicFabric(1e3, 5e2, 0.2, 3e2), 0.1, Vec3(1, 1, 0)});
      add("wrinkling fabric " + of, mesh,
          Membrane{TensionField<OrthotropicFabric>{OrthotropicFabric(1e3, 5e2, 0.2, 3e2)}, 0.1, Vec3(1, 1, 0)});
      add("wrinkling neo-Hookean " + of, mesh, Membrane{TensionField<PlaneNeoHookean>{plane_neo_hookean}, 0.1});
      add("wrinkling Saint Venant-Kirchhoff " + of, mesh,
          Membrane{TensionField<PlaneSaintVenantKirchhoff>{plane_saint_venant_kirchhoff}, 0.1});
    }
    add("cables", line(), Cable{{1e6, false}, 1e-3});
    add("slack cables", line(), Cable{{1e6, true}, 1e-3, 1.02});
  }
  const Membrane soft{plane_neo_hookean, 1e-9};
  all.push_back({"pressure on quadrilaterals", sheet(), {"", 1.0, soft}, {{"", Expression(1e3)}}});
  all.push_back({"pressure on triangles", triangles(), {"", 1.0, soft}, {{"", Expression(1e3)}}});
  return all;
}

TEST(Stiffness, is_the_derivative_of_the_forces) {
  for (const Sample& sample : samples()) {
    const std::vector<Region> regions{sample.region};
    Elements elements(sample.mesh, regions, sample.pressures, {0.05, 20.0});
    elements.set_time(0.0);
    const std::size_t nodes = sample.mesh.nodes.size();
    const auto x = sum(sample.mesh.nodes, random_vectors(nodes, sample.amplitude, 1));
    const auto direction = random_vectors(nodes, 1.0, 2);
    const auto forces_at = [&](double step) {
      auto moved = x;
      for (std::size_t i = 0; i < nodes; ++i) moved[i] += step * direction[i];
      elements.compute_forces(moved);
      std::vector<Vec3> force;
      for (std::size_t i = 0; i < nodes; ++i) force.push_back(elements.nodal_force(static_cast<int>(i)));
      return force;
    };
    TangentStiffness stiffness(elements);
    stiffness.update(x);
    const auto product = stiffness.times(direction);
    constexpr double h = 1e-7;
    const auto ahead = forces_at(h), behind = forces_at(-h);
    std::vector<Vec3> difference(nodes);
    for (std::size_t i = 0; i < nodes; ++i) difference[i] = product[i] + (ahead[i] - behind[i]) / (2.0 * h);
    EXPECT_LT(largest_norm(difference), 1e-6 * largest_norm(product)) << sample.name;
    EXPECT_GT(largest_norm(product), 0.0) << sample.name;
  }
}

}  // namespace
}  // namespace drogue::fem
