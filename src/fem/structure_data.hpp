// SPDX-License-Identifier: GPL-3.0-or-later
// State of a Structure. Its unknowns are the coordinates of its points: a node's position, or of a pair {a, b} the mean
//   x_m = s_a x_a + s_b x_b  and the difference  d = x_a - x_b,  s_a = m_a / (m_a + m_b), s_b = 1 - s_a.
#pragma once

#include <vector>

#include "fem/hex_elements.hpp"
#include "fem/structure.hpp"

namespace drogue::fem {

/// Mass that resists in a coordinate, and reference volume by which a tether holds it.
struct Inertance {
  double mass;    ///< [kg]
  double volume;  ///< [m^3]
};

struct Point {
  int a, b;  ///< nodes; b is -1 for a single one
  double share_a, share_b;
  Inertance mean, difference;
  const Hold* hold;  ///< or nullptr

  bool is_pair() const { return b >= 0; }
  Vec3 mean_of(const std::vector<Vec3>& field) const {
    return is_pair() ? Vec3(share_a * field[a] + share_b * field[b]) : field[a];
  }
};

struct Structure::Data {
  Data(HexMesh mesh, const Material& material, const StructureOptions& options, std::vector<Hold> holds);

  const HexMesh mesh;
  const Material material;
  const StructureOptions options;
  const std::vector<Hold> holds;
  std::vector<const Hold*> hold_of_node;
  HexElements elements;
  std::vector<double> own_mass;
  std::vector<Vec3> x, v;

  Inertia inertia;
  std::vector<Point> points;
  std::vector<int> thickness_direction;          ///< parent direction along which pairs face each other; -1: none
  std::vector<std::array<double, 3>> lightness;  ///< of each element and parent direction: own mass over mass in use
  std::vector<double> stiffness_bounds;          ///< of each element, as deformed [Pa/m^2]
  std::vector<Vec3> hold_impulse;                ///< of each point in the last advance [N s]

  double largest_frequency = 0.0;
  int substeps = 0;
  Vec3 reaction = Vec3::Zero();

  void assign_points(Inertia inertia);
  void compare_masses();
  void estimate_largest_frequency();
  double stable_step() const;
  int substeps_for(double dt) const;
  void stop_rigidly_held();
  void move(std::size_t point, double dt);
  [[noreturn]] void report_divergence(double time) const;
};

}  // namespace drogue::fem
