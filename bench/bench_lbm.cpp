// SPDX-License-Identifier: GPL-3.0-or-later
// Million cell updates per second of the fluid: a uniform periodic box out of memory and in cache, by storage and
// threads, and a refined grid against the uniform rate. Best of the repetitions is what the tables of
// docs/benchmarks.md hold:
//   bench_lbm --benchmark_repetitions=5 --benchmark_report_aggregates_only=false
#include <benchmark/benchmark.h>
#include <omp.h>

#include <ctime>

#include "lbm/solver.hpp"

namespace {

using namespace drogue;

fluid::Specification shear_flow(double sigma) {
  fluid::Specification s;
  s.density = 1.0;
  s.viscosity = 1e-4;
  s.reference_velocity = 1.0;
  s.hrr_sigma = sigma;
  s.initial_velocity = {Expression("sin(2*pi*y)"), Expression("0.1*sin(2*pi*x)"), Expression(0.0)};
  return s;
}

template <class Solver>
void run(benchmark::State& state, Solver& solver) {
  solver.step(nullptr);
  const auto before = solver.statistics().cell_updates;
  const std::clock_t start = std::clock();
  for (auto _ : state) solver.step(nullptr);
  const double cpu_seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const double updates = 1e-6 * static_cast<double>(solver.statistics().cell_updates - before);
  state.counters["MLUPS"] = benchmark::Counter(updates, benchmark::Counter::kIsRate);
  // what the same cores would do if nobody else used them
  state.counters["MLUPS_cpu"] = updates * omp_get_max_threads() / cpu_seconds;
}

/// Arguments: cells across, threads, 1000 sigma.
template <class S, fluid::EddyViscosity eddy = fluid::EddyViscosity::none>
void uniform(benchmark::State& state) {
  omp_set_num_threads(static_cast<int>(state.range(1)));
  const double dx = 1.0 / static_cast<double>(state.range(0));
  amr::Forest forest({{Vec3::Zero(), Vec3::Ones()}, dx, {true, true, true}}, 0, amr::any_of({}));
  fluid::Specification specification = shear_flow(static_cast<double>(state.range(2)) / 1000.0);
  specification.eddy_viscosity = eddy;
  specification.eddy_constant = 0.07;
  lbm::BasicSolver<S> solver(std::move(forest), specification);
  run(state, solver);
}

/// Arguments: levels, threads. A cube of nested cubes, each half as wide as the one around it.
void refined(benchmark::State& state) {
  omp_set_num_threads(static_cast<int>(state.range(1)));
  const double dx = 1.0 / 128;
  std::vector<amr::RefinementCriterion> cubes;
  double half = 0.25, spacing = dx;
  for (int level = 1; level < state.range(0); ++level) {
    spacing /= 2;
    cubes.push_back(amr::refine_box({Vec3::Constant(0.5 - half), Vec3::Constant(0.5 + half)}, dx, spacing));
    half /= 2;
  }
  amr::Forest forest({{Vec3::Zero(), Vec3::Ones()}, dx, {true, true, true}}, static_cast<int>(state.range(0)) - 1,
                     amr::any_of(std::move(cubes)));
  lbm::Solver solver(std::move(forest), shear_flow(0.98));
  run(state, solver);
}

}  // namespace

BENCHMARK(uniform<lbm::DefaultStress>)
    ->ArgNames({"cells", "threads", "sigma"})
    ->ArgsProduct({{224, 48}, {1, 2}, {980, 1000}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(uniform<lbm::DefaultStress, fluid::EddyViscosity::vreman>)
    ->ArgNames({"cells", "threads", "sigma"})
    ->ArgsProduct({{224}, {1, 2}, {980}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(uniform<lbm::FloatStress>)
    ->ArgNames({"cells", "threads", "sigma"})
    ->ArgsProduct({{224}, {1, 2}, {980}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(refined)
    ->ArgNames({"levels", "threads"})
    ->ArgsProduct({{1, 3, 5}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
