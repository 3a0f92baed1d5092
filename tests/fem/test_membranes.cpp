// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of plane stress, membranes made of them, and their equilibrium under pressure.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bodies.hpp"
#include "fem/plane_stress.hpp"

namespace drogue::fem {
namespace {

using Plane = PlaneTensor<double>;

const PlaneNeoHookean neo_hookean{NeoHookean(1e3, 0.3, 0.3)};
const PlaneSaintVenantKirchhoff saint_venant_kirchhoff{SaintVenantKirchhoff(1e3, 0.3)};
const std::vector<MembraneMaterial> laws{neo_hookean,
                                         saint_venant_kirchhoff,
                                         OrthotropicFabric(2e3, 1e3, 0.4, 300.0),
                                         TensionField<PlaneNeoHookean>{neo_hookean},
                                         TensionField<PlaneSaintVenantKirchhoff>{saint_venant_kirchhoff},
                                         TensionField<OrthotropicFabric>{OrthotropicFabric(2e3, 1e3, 0.4, 300.0)}};

double norm(const Plane& a) { return std::sqrt(dot(a, a)); }

/// Right Cauchy-Green tensors with principal stretches `a` and `b`, the first at `angle` to the x axis.
Plane stretched(double a, double b, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {a * a * c * c + b * b * s * s, a * a * s * s + b * b * c * c, (a * a - b * b) * c * s};
}

/// Taut, wrinkled and slack states.
const std::vector<Plane> states{stretched(1.2, 1.1, 0.3), stretched(1.3, 0.95, 1.0), stretched(1.25, 0.6, -0.5),
                                stretched(1.1, 0.3, 2.0), stretched(0.95, 0.8, 0.7)};

TEST(PlaneLaws, equibiaxial_stress_and_thickness_follow_the_reference_table) {
  struct Row {
    double stretch, neo_hookean, thickness, saint_venant_kirchhoff;
  };
  for (const Row& row :
       {Row{0.90, -174.49, 1.08881, -122.14}, Row{1.05, 65.188, 0.95808, 76.875}, Row{1.10, 119.61, 0.91818, 165.00},
        Row{1.20, 204.24, 0.84487, 377.14}, Row{1.30, 265.997, 0.78029, 640.71}, Row{1.50, 348.23, 0.67499, 0.0}}) {
    const Plane c = stretched(row.stretch, row.stretch, 0.0);
    EXPECT_NEAR(row.stretch * neo_hookean.stress(c).xx / row.neo_hookean, 1.0, 1e-4) << row.stretch;
    EXPECT_NEAR(neo_hookean.volume_ratio(c) / (row.stretch * row.stretch * row.thickness), 1.0, 1e-5) << row.stretch;
    if (row.saint_venant_kirchhoff == 0.0) continue;
    EXPECT_NEAR(row.stretch * saint_venant_kirchhoff.stress(c).xx / row.saint_venant_kirchhoff, 1.0, 1e-4);
  }
}

TEST(PlaneLaws, tension_field_in_uniaxial_tension_follows_the_reference_table) {
  struct Row {
    double stretch, neo_hookean, saint_venant_kirchhoff;
  };
  for (const Row& row : {Row{1.05, 47.350, 53.813}, Row{1.10, 89.971, 115.50}, Row{1.20, 163.79, 264.00},
                         Row{1.30, 225.71, 448.50}, Row{1.50, 324.33, 937.50}}) {
    const Plane narrow = stretched(row.stretch, 0.5, 0.0);
    const auto field = TensionField<PlaneNeoHookean>{neo_hookean};
    EXPECT_NEAR(row.stretch * field.stress(narrow).xx / row.neo_hookean, 1.0, 1e-4) << row.stretch;
    const auto other = TensionField<PlaneSaintVenantKirchhoff>{saint_venant_kirchhoff};
    EXPECT_NEAR(row.stretch * other.stress(narrow).xx / row.saint_venant_kirchhoff, 1.0, 1e-4) << row.stretch;
  }
}

TEST(PlaneLaws, stress_is_twice_the_derivative_of_the_energy_and_the_tangent_that_of_the_stress) {
  constexpr double h = 1e-5;
  const Plane direction{0.3, -0.7, 0.4};
  for (const MembraneMaterial& material : laws) {
    std::visit(
        [&](const auto& law) {
          for (const Plane& c : states) {
            const Plane up = c + h * direction, down = c - h * direction;
            const double slope = (law.energy(up) - law.energy(down)) / (2.0 * h);
            EXPECT_NEAR(0.5 * dot(law.stress(c), direction), slope, 1e-6 * std::abs(slope) + 1e-6);
            const Plane numeric = (0.5 / h) * (law.stress(up) - law.stress(down));
            EXPECT_LT(norm(law.tangent(c, direction) - numeric), 1e-6 * norm(numeric) + 1e-9);
          }
        },
        material);
  }
}

TEST(PlaneLaws, thickness_agrees_with_that_of_the_law_in_three_dimensions) {
  for (const auto& [a, b] : {std::pair{1.2, 1.1}, std::pair{1.4, 0.8}, std::pair{0.7, 0.9}}) {
    const Plane c = stretched(a, b, 0.4);
    EXPECT_NEAR(neo_hookean.volume_ratio(c), a * b * plane_stress_thickness(neo_hookean.solid, a, b), 1e-10);
    const double t = plane_stress_thickness(saint_venant_kirchhoff.solid, a, b);
    EXPECT_NEAR(saint_venant_kirchhoff.volume_ratio(c), a * b * t, 1e-10);
  }
}

TEST(PlaneLaws, a_tension_field_is_never_compressed) {
  const auto field = TensionField<PlaneNeoHookean>{neo_hookean};
  for (double a = 0.3; a < 1.5; a += 0.05) {
    for (double b = 0.3; b <= a; b += 0.05) {
      const Plane s = field.stress(stretched(a, b, 0.6));
      EXPECT_GE(s.xx + s.yy, 0.0);
      EXPECT_GE(determinant(s), -1e-12 * dot(s, s));
    }
  }
  EXPECT_EQ(norm(field.stress(stretched(0.99, 0.5, 0.2))), 0.0);
}

/// All principal stretches between 0.4 and 1.4, all ways round.
template <class Visit>
void each_state(const Visit& visit) {
  for (double a = 0.4; a < 1.4; a += 0.1) {
    for (double b = 0.4; b <= a; b += 0.1) {
      for (double angle = 0.05; angle < std::numbers::pi; angle += 0.2) visit(stretched(a, b, angle));
    }
  }
}

const OrthotropicFabric stiff_in_warp(2e3, 300.0, 0.4, 20.0);
const TensionField<OrthotropicFabric> folding{stiff_in_warp};

TEST(FabricTensionField, of_an_isotropic_fabric_is_that_of_the_isotropic_law) {
  const TensionField<PlaneSaintVenantKirchhoff> isotropic{saint_venant_kirchhoff};
  const TensionField<OrthotropicFabric> fabric{OrthotropicFabric(1e3, 1e3, 0.3, 1e3 / 2.6)};
  each_state([&](const Plane& c) {
    EXPECT_NEAR(fabric.energy(c), isotropic.energy(c), 1e-9);
    EXPECT_LT(norm(fabric.stress(c) - isotropic.stress(c)), 1e-6);
  });
}

TEST(FabricTensionField, is_never_compressed_and_gives_uniaxial_tension_where_it_folds) {
  int folded = 0;
  each_state([&](const Plane& c) {
    const Plane s = folding.stress(c);
    EXPECT_GE(trace(s), 0.0);
    EXPECT_GE(determinant(s), -1e-12 * dot(s, s));
    if (determinant(stiff_in_warp.stress(c)) >= 0.0 || trace(s) == 0.0) return;
    ++folded;
    // The strain that is left over is a fold: a shortening across the tension, which does no work.
    const Plane over = green_lagrange(c) - stiff_in_warp.strain_of(s);
    EXPECT_LT(trace(over), 0.0);
    EXPECT_NEAR(determinant(over), 0.0, 1e-9);
    EXPECT_NEAR(dot(over, s), 0.0, 1e-7 * norm(s));
  });
  EXPECT_GT(folded, 100);
}

TEST(FabricTensionField, along_the_yarns_and_in_pure_shear_is_what_the_theory_says) {
  // Pulled along the warp and pushed together across, it bears E_1 times the strain.
  const Plane pulled = folding.stress(Plane{1.2, 0.5, 0.0});
  EXPECT_NEAR(pulled.xx, 2e3 * 0.1, 1e-9);
  EXPECT_NEAR(pulled.yy, 0.0, 1e-9);
  // Sheared by a small angle between equal yarns it folds along a diagonal: D_tt = (1 / E_1 + 1 / E_2 + 1 / G) / 4.
  const double young = 1e3, shear = 50.0, e = 1e-3;
  const TensionField<OrthotropicFabric> equal{OrthotropicFabric(young, young, 0.0, shear)};
  const Plane sheared = equal.stress(Plane{1.0, 1.0, 2.0 * e});
  EXPECT_NEAR(norm(sheared), e * 4.0 / (2.0 / young + 1.0 / shear), 1e-9);
  EXPECT_NEAR(sheared.xx, sheared.xy, 1e-9);
}

TEST(FabricTensionField, is_convex_below_the_law_and_lowered_by_folds) {
  const auto strain = random_vectors(400, 0.3, 3);
  const auto energy = [](const Vec3& e) { return folding.energy(Plane{1 + 2 * e[0], 1 + 2 * e[1], 2 * e[2]}); };
  for (std::size_t k = 0; k + 1 < strain.size(); k += 2) {
    const Vec3 &a = strain[k], &b = strain[k + 1];
    EXPECT_LE(energy(a), stiff_in_warp.energy(Plane{1 + 2 * a[0], 1 + 2 * a[1], 2 * a[2]}) * (1.0 + 1e-12));
    EXPECT_LE(energy(0.5 * (a + b)), 0.5 * (energy(a) + energy(b)) + 1e-12);
    // Nothing that folds adds to it costs anything.
    const double angle = a[0] * 10.0;
    const Vec3 fold = Vec3(std::pow(std::cos(angle), 2), std::pow(std::sin(angle), 2), 0.5 * std::sin(2 * angle));
    EXPECT_LE(energy(a - 0.1 * fold), energy(a) + 1e-12);
  }
}

TEST(FabricTensionField, packs_do_what_numbers_do) {
  each_state([&](const Plane& c) {
    const PlaneTensor<Pack> packs{splat<Pack>(c.xx), splat<Pack>(c.yy), splat<Pack>(c.xy)};
    const auto s = folding.stress(packs);
    const Plane expected = folding.stress(c);
    EXPECT_NEAR(s.xx[0], expected.xx, 1e-9);
    EXPECT_NEAR(s.xy[lanes - 1], expected.xy, 1e-9);
  });
}

Mesh patch(bool triangles) {
  Mesh mesh = make_sheet(
      {{Vec3(0, 0, 0), Vec3(0.4, 0.05, 0.1), Vec3(0.45, 0.4, 0.2), Vec3(-0.05, 0.3, 0.05)}, {4, 3}, triangles});
  const auto shift = random_vectors(mesh.nodes.size(), 0.02, 5);
  for (std::size_t i = 0; i < shift.size(); ++i) mesh.nodes[i] += shift[i];
  return mesh;
}

Structure membrane(Mesh mesh, const MembraneMaterial& material, double thickness = 1e-3) {
  return Structure({std::move(mesh), {{"", 1.0, Membrane{material, thickness}}}, {}, {}});
}

TEST(Membranes, forces_are_minus_the_gradient_of_the_energy) {
  for (const bool triangles : {false, true}) {
    const Mesh mesh = patch(triangles);
    const Mat3 stretch{{1.2, 0.1, -0.05}, {0.02, 0.9, 0.1}, {0.1, -0.1, 1.1}};
    const auto x = sum(mapped(mesh.nodes, stretch), random_vectors(mesh.nodes.size(), 0.01, 1));
    const auto direction = random_vectors(mesh.nodes.size(), 1.0, 2), rest = std::vector<Vec3>(x.size(), Vec3::Zero());
    for (const MembraneMaterial& law : laws) {
      Structure body = membrane(mesh, law);
      const auto energy_at = [&](double step) {
        auto moved = x;
        for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += step * direction[i];
        body.set_state(moved, rest);
        return body.elastic_energy();
      };
      constexpr double h = 1e-6;
      const auto force = internal_force(body, x);
      double power = 0.0;
      for (std::size_t i = 0; i < force.size(); ++i) power += force[i].dot(direction[i]);
      EXPECT_NEAR(power, -(energy_at(h) - energy_at(-h)) / (2.0 * h), 1e-6 * std::abs(power));
    }
  }
}

TEST(Membranes, rotation_gives_no_force_and_forces_have_no_resultant) {
  for (const bool triangles : {false, true}) {
    const Mesh mesh = patch(triangles);
    for (const MembraneMaterial& law : laws) {
      const Structure body = membrane(mesh, law);
      const auto turned = mapped(mesh.nodes, rotation(0.5 * std::numbers::pi, Vec3(1, 2, 3)));
      EXPECT_LT(largest_norm(internal_force(body, turned)), 1e-14);
      const auto x = sum(turned, random_vectors(mesh.nodes.size(), 0.03, 3));
      Vec3 resultant = Vec3::Zero(), torque = Vec3::Zero();
      const auto force = internal_force(body, x);
      for (std::size_t i = 0; i < x.size(); ++i) {
        resultant += force[i];
        torque += x[i].cross(force[i]);
      }
      EXPECT_LT(resultant.norm() + torque.norm(), 1e-14);
    }
  }
}

TEST(Membranes, mass_is_that_of_the_area) {
  Mesh mesh = make_disk({Vec3::Zero(), 2, 1.0, {6, 6}});
  const Structure disk = membrane(mesh, neo_hookean, 0.01);
  double mass = 0.0;
  for (const double m : disk.own_mass()) mass += m;
  // A polygon of 24 corners.
  EXPECT_NEAR(mass, 0.01 * 12.0 * std::sin(2.0 * std::numbers::pi / 24.0), 1e-12);
}

/// Largest eigenvalue of M^-1 K by power iteration with finite differences.
double largest_squared_frequency(const Structure& body, const std::vector<Vec3>& x) {
  auto mode = random_vectors(x.size(), 1.0, 11);
  double value = 0.0;
  for (int iteration = 0; iteration < 300; ++iteration) {
    double norm = 0.0;
    for (const Vec3& u : mode) norm += u.squaredNorm();
    constexpr double h = 1e-6;
    auto up = x, down = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec3 step = h / std::sqrt(norm) * mode[i];
      up[i] += step;
      down[i] -= step;
    }
    const auto f_up = internal_force(body, up), f_down = internal_force(body, down);
    double next = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      mode[i] = (f_down[i] - f_up[i]) / (2.0 * h * body.own_mass()[i]);
      next += mode[i].squaredNorm();
    }
    value = std::sqrt(next);
  }
  return value;
}

TEST(Membranes, stable_step_bounds_the_largest_frequency_closely) {
  for (const bool triangles : {false, true}) {
    for (const MembraneMaterial& law : {laws[0], laws[1], laws[2]}) {
      Mesh mesh = make_sheet({{Vec3(0, 0, 0), Vec3(0.4, 0, 0), Vec3(0.4, 0.3, 0), Vec3(0, 0.3, 0)}, {6, 5}, triangles});
      Structure body = membrane(mesh, law);
      const auto x = mapped(mesh.nodes, Mat3(Vec3(1.1, 1.05, 1.0).asDiagonal()));
      body.set_state(x, std::vector<Vec3>(x.size(), Vec3::Zero()));
      const double ratio = body.largest_frequency() / std::sqrt(largest_squared_frequency(body, x));
      EXPECT_GE(ratio, 0.999) << triangles;
      EXPECT_LE(ratio, 1.8) << triangles;
    }
  }
}

// P_a : dF = J T (F f0) . (dF f0), with the fibre along the warp of a membrane.
TEST(ActiveStress, pulls_along_the_fibre_of_membranes_and_solids) {
  const Mat3 stretch = Vec3(1.2, 0.9, 1.1).asDiagonal();
  const double tension = 50.0;
  const auto virial = [&](Model model) {
    const Mesh mesh = model.mesh;
    model.regions[0].active = {Expression(tension), Vec3::UnitX()};
    Structure active(model);
    model.regions[0].active.tension = Expression(0.0);
    Structure passive(model);
    const auto x = mapped(mesh.nodes, stretch);
    const auto with = internal_force(active, x), without = internal_force(passive, x);
    Mat3 sum = Mat3::Zero();
    for (std::size_t i = 0; i < x.size(); ++i) sum -= (with[i] - without[i]) * mesh.nodes[i].transpose();
    return sum;
  };
  Mat3 expected = Mat3::Zero();
  expected(0, 0) = 1.2 * 0.9 * 1.1 * tension * 1.2;
  const Mat3 solid = virial(one_solid(block({0.2, 0.1, 0.1}, {2, 2, 1}), neo_hookean.solid, 1.0));
  EXPECT_LT((solid / (0.2 * 0.1 * 0.1) - expected).norm(), 1e-10);
  Mesh sheet = make_sheet({{Vec3(0, 0, 0), Vec3(0.2, 0, 0), Vec3(0.2, 0.1, 0), Vec3(0, 0.1, 0)}, {2, 2}});
  const OrthotropicFabric fabric(1e3, 1e3, 0.0, 400.0);
  expected(0, 0) = 1.2 * 0.9 * tension * 1.2;
  const Mat3 membrane_virial = virial({sheet, {{"", 1.0, Membrane{fabric, 1e-3}}}, {}, {}});
  EXPECT_LT((membrane_virial / (0.2 * 0.1 * 1e-3) - expected).norm(), 1e-10);
}

/// Height of the middle over the radius of a flat, clamped, nearly incompressible disk.
double inflated(double load, bool triangles) {
  Mesh mesh = make_disk({Vec3::Zero(), 2, 1.0, {8, 8}, triangles});
  const double shear = 1.0, thickness = 1e-3, poisson = 0.4999;
  const int apex = mesh.node_sets.at("centre")[0];
  const NeoHookean law(2.0 * shear * (1.0 + poisson), poisson, poisson);
  Model model{mesh, {{"", 1.0, Membrane{PlaneNeoHookean{law}, thickness}}}, {}, {}};
  model.loads.holds = {{.nodes = mesh.node_sets.at("rim"), .rigid = true}};
  model.loads.pressures = {{"", Expression(load * shear * thickness)}};
  Structure disk(std::move(model));
  disk.find_equilibrium(0.0, {.method = Equilibrium::relaxation, .tolerance = 1e-5});
  EXPECT_LT(std::abs(disk.reaction().x()), 1e-8);
  return disk.position()[apex].z();
}

TEST(Membranes, a_circular_membrane_rises_as_the_exact_solution_says) {
  for (const bool triangles : {false, true}) {
    for (const auto& [load, height] : {std::pair{0.1, 0.19924}, std::pair{0.5, 0.37430}, std::pair{1.0, 0.53121}}) {
      EXPECT_NEAR(inflated(load, triangles) / height, 1.0, 0.01) << load << " triangles: " << triangles;
    }
  }
}

TEST(Pressure, has_no_resultant_on_a_closed_surface_and_its_area_on_an_open_one) {
  for (const bool triangles : {false, true}) {
    Mesh mesh = make_sheet({{Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 3, 0), Vec3(0, 3, 0)}, {3, 2}, triangles});
    Model model{mesh, {{"", 1.0, Membrane{neo_hookean, 1e-3}}}, {}, {}};
    model.loads.pressures = {{"", Expression("10*t")}};
    Structure sheet(std::move(model));
    sheet.advance(1e-9, 0.5);
    Vec3 momentum = Vec3::Zero();
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) momentum += sheet.own_mass()[i] * sheet.velocity()[i];
    EXPECT_NEAR(momentum.z() / 1e-9, 5.0 * 6.0, 1e-6);
  }
}

}  // namespace
}  // namespace drogue::fem
