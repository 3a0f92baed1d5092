// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/fate.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/case_reader.hpp"
#include "app/simulation.hpp"
#include "core/error.hpp"

namespace drogue::bench {

namespace {

constexpr double largest_energy = 1.01, largest_speed = 3.0;
constexpr int samples = 100;

/// Kinetic energy over the leaves per density [m^5/s^2].
double kinetic_energy(const fluid::FluidSolver& fluid) {
  const amr::Forest& forest = fluid.forest();
  const auto fields = std::make_unique<fluid::BlockFields>();
  double energy = 0.0;
  for (int level = 0; level < forest.levels(); ++level) {
    const auto leaves = forest.range(level, amr::Kind::leaf);
    double sum = 0.0;
    for (int id = leaves.begin; id < leaves.end; ++id) {
      fluid.read_block(id, *fields);
      for (const auto& component : fields->velocity) {
        for (const double u : component) sum += 0.5 * u * u;
      }
    }
    energy += sum * std::pow(forest.spacing(level), 3);
  }
  return energy;
}

/// p4est and MPI, which the grid is made with, are for one thread at a time.
std::unique_ptr<app::Simulation> make_simulation(const app::Case& c, const std::filesystem::path& folder) {
  std::unique_ptr<app::Simulation> simulation;
  std::exception_ptr failure;  // must not leave a critical section
#pragma omp critical(make_simulation)
  try {
    simulation = std::make_unique<app::Simulation>(c, folder);
  } catch (...) {
    failure = std::current_exception();
  }
  if (failure) std::rethrow_exception(failure);
  return simulation;
}

bool is_finite(const app::Simulation& simulation) {
  const fluid::FluidSolver& fluid = *simulation.fluid();
  return std::isfinite(fluid.mass_and_momentum()[0]) && std::ranges::all_of(simulation.bodies(), [&](const auto& body) {
           const app::BodyRow row = body->measure(&fluid);
           return row.force.allFinite() && row.centre.allFinite();
         });
}

/// Largest speed [m/s] that a face of the case lets in, or by which that changes.
double inlet_speed(const app::Case& c) {
  double largest = c.fluid.reference_velocity;
  for (const fluid::Face& face : c.fluid.face) {
    if (face.type != fluid::Boundary::velocity) continue;
    const auto velocity = [&](double time) {
      Vec3 u;
      for (int a = 0; a < 3; ++a) u[a] = face.velocity[a](c.domain.box.lower, time);
      return u;
    };
    for (int i = 0; i <= samples; ++i) {
      const Vec3 u = velocity(c.end * i / samples);
      largest = std::max({largest, u.norm(), (u - velocity(0.0)).norm()});
    }
  }
  return largest;
}

/// `fate` is up to date also when a step throws.
void step_to_end(app::Simulation& simulation, const app::Case& c, Bound bound, Fate& fate) {
  const fluid::FluidSolver& fluid = *simulation.fluid();
  const bool energy = bound == Bound::energy;
  const double unit = energy ? kinetic_energy(fluid) : inlet_speed(c);
  bool is_number = true;
  fate.outcome = outcome::survived;
  int sample = energy ? 1 : samples / 2;
  while (fluid.time() < c.end * (1.0 - 1e-9)) {
    simulation.step();
    fate.end = fluid.time();
    if (fate.end < sample * c.end / samples) continue;
    ++sample;
    fate.last = (energy ? kinetic_energy(fluid) : fluid.statistics().max_speed) / unit;
    fate.largest = std::max(fate.largest, fate.last);
    is_number = is_number && std::isfinite(fate.last) && is_finite(simulation);
  }
  if (fate.largest > (energy ? largest_energy : largest_speed)) fate.outcome = outcome::unbounded;
  if (!is_number) fate.outcome = outcome::silent;
}

}  // namespace

Fate follow(const std::filesystem::path& file, const std::vector<std::string>& overrides,
            const std::function<void(app::Case&)>& adjust, Bound bound, const std::filesystem::path& folder) {
  Fate fate{outcome::refused};
  try {
    app::Case c = app::read_case(file, overrides);
    adjust(c);
    const auto simulation = make_simulation(c, folder);
    step_to_end(*simulation, c, bound, fate);
  } catch (const Diverged& error) {
    fate.outcome = outcome::diverged;
    fate.message = error.what();
  } catch (const InputError& error) {
    if (fate.outcome != outcome::refused) fate.outcome = outcome::left;
    fate.message = error.what();
  }
  return fate;
}

}  // namespace drogue::bench
