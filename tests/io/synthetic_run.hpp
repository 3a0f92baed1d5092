// SPDX-License-Identifier: GPL-3.0-or-later
// A fluid and a canopy given by formulas: what the writers and the pictures are tested with, and no solver is needed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fem/mesh.hpp"
#include "fluid/fluid_solver.hpp"

namespace drogue::test {

/// Vortex rings of radius `radius` around the x axis, carried by a uniform stream of 1 m/s.
struct VortexRings {
  double radius = 0.42, core = 0.14, strength = 0.16;
  std::vector<double> centre{0.35};

  /// u = e_x + curl(A e_theta), A = strength exp(-((r - R)^2 + (x - x0)^2) / core^2): free of divergence.
  Vec3 velocity(const Vec3& p) const {
    const double r = std::max(std::hypot(p.y(), p.z()), 1e-9);
    Vec3 u(1.0, 0.0, 0.0);
    for (double x0 : centre) {
      const double dx = p.x() - x0, dr = r - radius;
      const double a = strength * std::exp(-(dr * dr + dx * dx) / (core * core));
      u.x() += a / r - 2.0 * dr / (core * core) * a;
      const double radial = 2.0 * dx / (core * core) * a;
      u += Vec3(0.0, p.y(), p.z()) * (radial / r);
    }
    return u;
  }
};

/// Gives the cell centres of leaves and parents the values of a formula.
class FormulaFluid : public fluid::FluidSolver {
 public:
  FormulaFluid(amr::Forest forest, VortexRings rings, double time)
      : forest_(std::move(forest)), rings_(std::move(rings)), time_(time) {}

  void step(fluid::FineStepHook*) override { throw std::logic_error("a formula does not step"); }
  const amr::Forest& forest() const override { return forest_; }
  double time() const override { return time_; }
  double coarse_dt() const override { return 1.0; }
  double fine_dt() const override { return 1.0; }
  const fluid::FluidStatistics& statistics() const override { return statistics_; }
  fluid::VelocityView fine_velocity() const override { throw std::logic_error("a formula has no finest level"); }
  std::array<double, 4> mass_and_momentum() const override { return {}; }
  void transfer_state(Archive&) override {}
  void read_block(int block, fluid::BlockFields& fields) const override {
    int n = 0;
    for (int k = 0; k < amr::block_size; ++k)
      for (int j = 0; j < amr::block_size; ++j)
        for (int i = 0; i < amr::block_size; ++i, ++n) {
          const Vec3 centre = forest_.cell_centre(block, {i, j, k});
          const Vec3 u = rings_.velocity(centre);
          for (int a = 0; a < 3; ++a) fields.velocity[a][n] = static_cast<float>(u[a]);
          fields.pressure[n] = pressure(centre);
        }
  }
  static float pressure(const Vec3& p) { return static_cast<float>(p.x() + 10.0 * p.y() + 100.0 * p.z()); }

 private:
  amr::Forest forest_;
  VortexRings rings_;
  double time_;
  fluid::FluidStatistics statistics_;
};

/// The channel of the square plate, refined towards the wake; `finest` 4 is the resolution of the case (1/64 m).
inline amr::Forest plate_forest(int finest) {
  const amr::Domain domain{{{-2.0, -2.0, -2.0}, {6.0, 2.0, 2.0}}, 0.25, {false, false, false}};
  return amr::Forest(domain, finest, [](const Box& box, int level) {
    const std::array<Box, 5> region{Box{{-1.5, -1.5, -1.5}, {5.0, 1.5, 1.5}}, Box{{-1.0, -1.0, -1.0}, {3.0, 1.0, 1.0}},
                                    Box{{-0.6, -0.9, -0.9}, {1.4, 0.9, 0.9}}, Box{{-0.2, -0.6, -0.6}, {0.7, 0.6, 0.6}}};
    return level < 4 && box.overlaps(region[static_cast<std::size_t>(level)]);
  });
}

inline fem::Mesh square_plate(int elements, double length = 0.8128, double thickness = 0.005) {
  fem::Mesh mesh;
  const int n = elements + 1;
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        mesh.nodes.emplace_back((side - 0.5) * thickness, (double(j) / elements - 0.5) * length,
                                (double(k) / elements - 0.5) * length);
  for (int k = 0; k < elements; ++k)
    for (int j = 0; j < elements; ++j) {
      const int a = k * n + j, b = a + 1, c = a + n + 1, d = a + n, back = n * n;
      mesh.hexahedra.push_back({a, b, c, d, a + back, b + back, c + back, d + back});
    }
  return mesh;
}

/// The plate blown to a dome that hangs at its corners; `depth` [m] at the centre.
inline std::vector<Vec3> dome(const fem::Mesh& mesh, double depth, double length = 0.8128) {
  std::vector<Vec3> position = mesh.nodes;
  for (Vec3& p : position) {
    const double y = 2.0 * p.y() / length, z = 2.0 * p.z() / length;
    const double rise = 1.0 - 0.5 * (y * y + z * z);
    p.x() += depth * rise;
    p.y() *= 1.0 - 0.25 * depth * (1.0 - z * z);
    p.z() *= 1.0 - 0.25 * depth * (1.0 - y * y);
  }
  return position;
}

}  // namespace drogue::test
