// SPDX-License-Identifier: GPL-3.0-or-later
// Solids in a fluid without dynamics, for the tests of this folder.
#pragma once

#include <gtest/gtest.h>
#include <omp.h>

#include <numeric>
#include <random>
#include <vector>

#include "../ib/fake_fluid.hpp"
#include "fem/mesh_shapes.hpp"
#include "fsi/coupling.hpp"

namespace drogue::testing {

inline constexpr double fluid_density = 1.2;

/// Runs its tests on one thread: bodies this small only wait for others.
class OnOneThread : public ::testing::Test {
 protected:
  OnOneThread() : threads_before_(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~OnOneThread() override { omp_set_num_threads(threads_before_); }

 private:
  int threads_before_;
};

/// Dragged mass over the fluid mass that a sheet of `thickness` displaces.
inline double dragged_over_displaced(double spacing, double thickness) {
  return spacing / (ib::sum_phi_squared(ib::Delta::peskin4) * thickness);
}

struct PlateOptions {
  double density = fluid_density;
  double side = 0.5, thickness = 0.01;
  int elements = 16;
  std::vector<fem::Hold> holds{};
  fem::StructureOptions structure{};
};

/// A plate normal to x in the middle of the fine cube, or of the periodic box.
inline fem::Structure plate(const PlateOptions& options, const Vec3& centre = Vec3(0.013, 0.004, -0.007)) {
  const int n = options.elements;
  return fem::Structure(
      fem::one_solid(fem::make_plate({centre, 0, {options.side, options.side}, options.thickness, {n, n, 1}}),
                     fem::NeoHookean(1000.0, 0.3, 0.3), options.density, options.holds, options.structure));
}

inline std::vector<int> all_nodes(int elements) {
  std::vector<int> nodes(2 * (elements + 1) * (elements + 1));
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

inline std::vector<Vec3> random_vectors(std::size_t count, double bound, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-bound, bound);
  std::vector<Vec3> vectors(count);
  for (Vec3& v : vectors) v = Vec3(unit(random), unit(random), unit(random));
  return vectors;
}

inline void add_velocity(fem::Structure& solid, const std::vector<Vec3>& change) {
  const std::vector<Vec3> x(solid.position().begin(), solid.position().end());
  std::vector<Vec3> v(solid.velocity().begin(), solid.velocity().end());
  for (std::size_t node = 0; node < v.size(); ++node) v[node] += change[node];
  solid.set_state(x, v);
}

inline double largest_speed(const fem::Structure& solid) {
  double largest = 0.0;
  for (const Vec3& v : solid.velocity()) largest = std::max(largest, v.norm());
  return largest;
}

inline fsi::CouplingOptions coupled(const std::string& body = "plate") {
  fsi::CouplingOptions options;
  options.fluid_density = fluid_density;
  options.body = body;
  return options;
}

}  // namespace drogue::testing
