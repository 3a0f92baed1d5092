// SPDX-License-Identifier: GPL-3.0-or-later
// Speed of the structure on the plate of the first case: 52 x 52 x 1 hexahedra of 0.8128 m x 0.8128 m x 5 mm, E = 1
// kPa.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "fem/elements.hpp"
#include "fem/mesh_shapes.hpp"
#include "fem/sparse_system.hpp"
#include "fem/structure.hpp"
#include "fem/thin_solid.hpp"

namespace {

using namespace drogue;
using namespace drogue::fem;

constexpr double pi = std::numbers::pi;

Mesh plate() { return make_plate({Vec3::Zero(), 0, {0.8128, 0.8128}, 5e-3, {52, 52, 1}}); }

/// Bulges the plate between its corners, and thins it there.
std::vector<Vec3> deformed(const Mesh& mesh) {
  std::vector<Vec3> x;
  for (const Vec3& X : mesh.nodes) {
    const double bulge = std::cos(X.y() * pi / 0.8128) * std::cos(X.z() * pi / 0.8128);
    x.emplace_back(0.2 * bulge + X.x() * (1.0 - 0.2 * bulge), X.y(), X.z());
  }
  return x;
}

void forces(benchmark::State& state, const Material& material, Hexahedron element) {
  const Mesh mesh = plate();
  const std::vector<Region> regions{{"", 1.0, Solid{material, element}}};
  Elements elements(mesh, regions, {}, {0.05, 20.0});
  const std::vector<Vec3> x = deformed(mesh);
  for (auto _ : state) elements.compute_forces(x);
  state.counters["Gauss points/s"] =
      benchmark::Counter(8.0 * elements.count() * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void stable_step(benchmark::State& state, const Material& material) {
  const Mesh mesh = plate();
  const std::vector<Region> regions{{"", 1.0, Solid{material}}};
  Elements elements(mesh, regions, {}, {0.05, 20.0});
  const std::vector<Vec3> x = deformed(mesh);
  for (auto _ : state) benchmark::DoNotOptimize(elements.largest_squared_frequency(x, elements.nodal_mass()));
}

void tangent(benchmark::State& state, const Material& material) {
  const Mesh mesh = plate();
  const std::vector<Region> regions{{"", 1.0, Solid{material}}};
  const Elements elements(mesh, regions, {}, {0.05, 20.0});
  TangentStiffness stiffness(elements);
  const std::vector<Vec3> x = deformed(mesh);
  for (auto _ : state) stiffness.update(x);
  state.counters["entries/s"] = benchmark::Counter(576.0 * elements.count() * static_cast<double>(state.iterations()),
                                                   benchmark::Counter::kIsRate);
}

/// Sum and factorisation of the tangent of a plate of n x n hexahedra, with a mass that makes it positive definite.
void factorisation(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const Mesh mesh = make_plate({Vec3::Zero(), 0, {0.8128, 0.8128}, 5e-3, {n, n, 1}});
  const std::vector<Region> regions{{"", 1.0, Solid{NeoHookean(1e3, 0.3, 0.3)}}};
  Elements elements(mesh, regions, {}, {0.05, 20.0});
  TangentStiffness stiffness(elements);
  stiffness.update(mesh.nodes);
  SparseSystem system(stiffness, SparseSystem::Held(mesh.nodes.size()), {});
  NodalMatrix mass{{}, {}};
  for (const double diagonal : elements.nodal_stiffness(mesh.nodes)) {
    mass.diagonal.emplace_back(Vec3::Constant(1e-3 * diagonal));
  }
  for (auto _ : state) system.factorise(mass);
  state.counters["operations"] = system.operations();
  state.counters["operations/s"] =
      benchmark::Counter(system.operations() * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

/// One fluid step of 7.8e-4 s, the pairs of nodes carrying 40 times their own mass, corners held. With contact nothing
/// is near.
void advance(benchmark::State& state, const Material& material, const std::optional<ContactOptions>& contact) {
  omp_set_num_threads(static_cast<int>(state.range(0)));
  const Mesh mesh = plate();
  const double density = 1.0;
  Model model = one_solid(mesh, material, density, {{corner_nodes(mesh, 0.0156), false, 1e7, 1e2}});
  model.loads.contact = contact;
  Structure structure(std::move(model));
  const auto pairs = thickness_pairs(mesh, 6e-3);
  Inertia inertia;
  inertia.point = pairs;
  inertia.face_mass.assign(structure.own_mass().begin(), structure.own_mass().end());
  for (const double area : pair_areas(mesh, pairs)) {
    inertia.heavy_mass.push_back(density * area * 5e-3);
    inertia.mass.push_back(40.0 * inertia.heavy_mass.back());
  }
  structure.set_inertia(inertia);
  const std::vector<Vec3> start = deformed(mesh), rest(start.size(), Vec3::Zero());
  int done = 0, substeps = 0;
  for (auto _ : state) {
    if (done++ % 100 == 0) structure.set_state(start, rest);
    structure.advance(7.8e-4, 0.0);
    substeps += structure.substeps();
  }
  state.counters["sub-steps"] = benchmark::Counter(substeps, benchmark::Counter::kAvgIterations);
  state.counters["Gauss points/s"] = benchmark::Counter(8.0 * 2704.0 * substeps, benchmark::Counter::kIsRate);
}

/// 4 ms of a sheet of fabric of 52 x 52 quadrilaterals that bulges at 1 m/s; with contact nothing is near. One thread.
void canopy(benchmark::State& state, const std::optional<ContactOptions>& contact) {
  omp_set_num_threads(1);
  const double h = 0.4064;
  const Mesh mesh = make_sheet({{Vec3(0, -h, -h), Vec3(0, h, -h), Vec3(0, h, h), Vec3(0, -h, h)}, {52, 52}});
  const OrthotropicFabric fabric(1e7, 1e7, 0.1, 4e6);
  Model model{mesh, {{"", 500.0, Membrane{fabric, 1e-4}}}, {}, {}};
  model.loads.contact = contact;
  Structure structure(std::move(model));
  std::vector<Vec3> v;
  for (const Vec3& x : mesh.nodes)
    v.emplace_back(std::cos(0.5 * pi * x.y() / h) * std::cos(0.5 * pi * x.z() / h), 0, 0);
  int substeps = 0;
  for (auto _ : state) {
    structure.set_state(mesh.nodes, v);
    for (int step = 0; step < 4; ++step) {
      structure.advance(1e-3, 0.0);
      substeps += structure.substeps();
    }
  }
  state.counters["sub-steps"] = benchmark::Counter(substeps, benchmark::Counter::kAvgIterations);
}

const NeoHookean neo_hookean(1e3, 0.3, 0.3);
const SaintVenantKirchhoff saint_venant_kirchhoff(1e3, 0.3);

BENCHMARK_CAPTURE(forces, neo_hookean / trilinear, neo_hookean, Hexahedron::trilinear);
BENCHMARK_CAPTURE(forces, neo_hookean / assumed_strain, neo_hookean, Hexahedron::assumed_strain);
BENCHMARK_CAPTURE(forces, saint_venant_kirchhoff / trilinear, saint_venant_kirchhoff, Hexahedron::trilinear);
BENCHMARK_CAPTURE(forces, saint_venant_kirchhoff / assumed_strain, saint_venant_kirchhoff, Hexahedron::assumed_strain);
BENCHMARK_CAPTURE(stable_step, neo_hookean, neo_hookean);
BENCHMARK_CAPTURE(stable_step, saint_venant_kirchhoff, saint_venant_kirchhoff);
BENCHMARK_CAPTURE(tangent, neo_hookean, neo_hookean);
BENCHMARK_CAPTURE(tangent, saint_venant_kirchhoff, saint_venant_kirchhoff);
BENCHMARK(factorisation)->Arg(13)->Arg(26)->Arg(52);
BENCHMARK_CAPTURE(advance, neo_hookean, neo_hookean, std::nullopt)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK_CAPTURE(advance, saint_venant_kirchhoff, saint_venant_kirchhoff, std::nullopt)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK_CAPTURE(advance, neo_hookean_with_contact, neo_hookean, ContactOptions{.gap = 8e-3})
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime();
BENCHMARK_CAPTURE(canopy, fabric, std::nullopt)->UseRealTime();
BENCHMARK_CAPTURE(canopy, fabric_with_contact, ContactOptions{.gap = 8e-3})->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
