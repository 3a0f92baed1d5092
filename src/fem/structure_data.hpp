// SPDX-License-Identifier: GPL-3.0-or-later
// State of a Structure.
#pragma once

#include <optional>
#include <vector>

#include "fem/contact.hpp"
#include "fem/elements.hpp"
#include "fem/point.hpp"
#include "fem/structure.hpp"

namespace drogue::fem {

struct Structure::Data {
  explicit Data(Model model);

  const Mesh mesh;
  const std::vector<Region> regions;
  const Loads loads;
  const StructureOptions options;
  std::vector<std::array<const Hold*, 3>> hold_of_node;
  Elements elements;
  std::vector<double> own_mass;
  std::vector<Vec3> x, v;

  Inertia inertia;
  std::vector<Point> points;
  std::optional<Contact> contact;
  struct ThinElement {
    std::array<int, 8> nodes;
    int direction;  ///< parent direction along which pairs face each other
    const Material* material;
  };
  std::vector<ThinElement> thin_elements;
  std::vector<Vec3> hold_impulse;       ///< of each point in the last advance [N s]
  std::vector<Vec3> dead_load;          ///< of each node now [N]; empty without any
  std::vector<bool> hold_moves;         ///< of each hold
  bool loads_vary = false;              ///< with time
  std::vector<Vec3> hold_displacement;  ///< of each hold now [m]

  std::vector<Vec3> forced_at;  ///< where stiffness-proportional damping takes the forces of the elements [m]
  double largest_frequency = 0.0;
  int substeps = 0;
  Vec3 reaction = Vec3::Zero();

  void assign_points(Inertia inertia);
  void compare_masses();
  void estimate_largest_frequency();
  void compute_forces(int substep);
  void compute_contact();
  double stable_step() const;
  int substeps_for(double dt) const;
  void stop_rigidly_held();
  void set_time(double time);
  /// Of elements, pressure and dead loads, without the weight [N].
  Vec3 nodal_force(int node) const {
    return dead_load.empty() ? elements.nodal_force(node) : Vec3(elements.nodal_force(node) + dead_load[node]);
  }
  double displacement_of(const Hold& hold, int axis) const {
    return hold_displacement[&hold - loads.holds.data()][axis];
  }
  struct Coordinate {
    Vec3 position, reference, velocity;
  };
  Vec3 resisted_change(const Point& p, const Inertance& inertance, const Vec3& f, bool follows, const Coordinate& at,
                       double dt) const;
  void move(std::size_t point, double dt);
  struct Balance {
    std::vector<Vec3> left;  ///< of each node [N]
    Vec3 reaction;           ///< of all holds on the body [N]
    double scale;            ///< norm of all loads and reactions [N]
  };
  Balance balance();
  void move_rigidly_held();
  std::vector<double> fictitious_masses(const std::vector<double>& least_stiffness);
  [[noreturn]] void report_divergence(double time) const;
};

}  // namespace drogue::fem
