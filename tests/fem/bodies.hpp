// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies, states and sums that several tests of the structure use.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "fem/mesh_shapes.hpp"
#include "fem/structure.hpp"
#include "fem/thin_solid.hpp"

namespace drogue::fem {

inline Mesh block(const std::array<double, 3>& size, const std::array<int, 3>& elements) {
  // The plate's sides follow its normal in cyclic order.
  return make_plate({Vec3::Zero(), 2, {size[0], size[1]}, size[2], elements});
}

struct SolidOptions {
  double density = 0.0;
  double dissipation = 0.2, safety = 0.9;
  std::array<double, 2> volume_ratio{0.05, 20.0};
  Hexahedron element = Hexahedron::assumed_strain;
};

/// All hexahedra of a mesh, of one material.
inline Structure solid(Mesh mesh, const Material& material, const SolidOptions& options, std::vector<Hold> holds) {
  Model model = one_solid(std::move(mesh), material, options.density, std::move(holds),
                          {options.dissipation, options.safety, options.volume_ratio});
  std::get<Solid>(model.regions.front().kind).element = options.element;
  return Structure(std::move(model));
}

/// The kinds of hexahedra, with their names.
inline const std::vector<std::pair<std::string, Hexahedron>> hexahedra{{"trilinear", Hexahedron::trilinear},
                                                                       {"assumed strain", Hexahedron::assumed_strain}};

inline std::vector<Vec3> random_vectors(std::size_t count, double amplitude, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  std::vector<Vec3> vectors(count);
  for (Vec3& v : vectors) v = {uniform(generator), uniform(generator), uniform(generator)};
  return vectors;
}

inline std::vector<Vec3> sum(std::vector<Vec3> a, const std::vector<Vec3>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
  return a;
}

inline std::vector<Vec3> mapped(const std::vector<Vec3>& x, const Mat3& f) {
  std::vector<Vec3> y;
  for (const Vec3& p : x) y.emplace_back(f * p);
  return y;
}

inline Mat3 rotation(double angle, const Vec3& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

inline std::vector<Vec3> internal_force(const Structure& body, const std::vector<Vec3>& x) {
  std::vector<Vec3> force(x.size());
  body.internal_force(x, force);
  return force;
}

inline std::vector<Vec3> copy(std::span<const Vec3> field) { return {field.begin(), field.end()}; }

inline double energy(const Structure& body) { return body.kinetic_energy() + body.elastic_energy(); }

/// Velocities of the leapfrog scheme stand half a sub-step behind; advanced to the positions they belong to an energy
/// that does not depend on the phase of a vibration.
inline double synchronised_energy(const Structure& body, double substep) {
  const auto force = internal_force(body, copy(body.position()));
  double power = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) power += force[i].dot(body.velocity()[i]);
  return energy(body) + 0.5 * substep * power;
}

inline double largest_norm(const std::vector<Vec3>& field) {
  double largest = 0.0;
  for (const Vec3& v : field) largest = std::max(largest, v.norm());
  return largest;
}

/// The pairs of a thin body, each with `factor` times its own mass.
inline Inertia paired(const Structure& body, double factor) {
  Inertia inertia{thickness_pairs(body.mesh(), 1e300), {}, {}, {body.own_mass().begin(), body.own_mass().end()}};
  for (const auto& [a, b] : inertia.point) {
    inertia.heavy_mass.push_back(body.own_mass()[a] + body.own_mass()[b]);
    inertia.mass.push_back(factor * inertia.heavy_mass.back());
  }
  return inertia;
}

inline Inertia single(const Structure& body, double factor) {
  Inertia inertia = body.inertia();
  for (double& mass : inertia.mass) mass *= factor;
  return inertia;
}

}  // namespace drogue::fem
