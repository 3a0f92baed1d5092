// SPDX-License-Identifier: GPL-3.0-or-later
// State of a Structure.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fem/contact.hpp"
#include "fem/elements.hpp"
#include "fem/newton.hpp"
#include "fem/point.hpp"
#include "fem/structure.hpp"

namespace drogue::fem {

struct Structure::Data {
  explicit Data(Model model);

  const Mesh mesh;
  const std::vector<Region> regions;
  const Loads loads;
  const StructureOptions options;
  std::vector<Holds> hold_of_node;
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
  double load_share = 1.0;              ///< of the loads that acts now
  std::unique_ptr<Newton> solver;       ///< once it is needed
  std::string free_motion;              ///< at the last equilibrium, in words; empty if there is none
  double reference_step = 0.0;          ///< stable_step() when the inertia was set [s]
  std::vector<Vec3> acceleration;       ///< of each node, of the implicit scheme; empty where unknown [m/s^2]
  NodalMatrix mass_matrix;              ///< of the points, see Inertia [kg]
  std::vector<double> moving_mass;      ///< of each node, behind the bound of frequencies [kg]
  std::vector<Vec3> nodal_weight;       ///< of each node [N]

  std::vector<Vec3> forced_at;  ///< where stiffness-proportional damping takes the forces of the elements [m]
  double largest_frequency = 0.0;
  int substeps = 0;
  Vec3 reaction = Vec3::Zero();

  void assign_points(Inertia inertia);
  void assemble_mass();
  void compare_masses();
  void estimate_largest_frequency();
  void compute_forces(int substep);
  void compute_contact();
  double stable_step() const;
  /// In `dt` with the `stable` step, and for resets of velocities [s].
  double explicit_substeps(double dt, double stable) const;
  int substeps_for(double dt, double time);
  void stop_rigidly_held();
  /// A share of the loads of `time` [s] acts from now on.
  void set_time(double time, double share = 1.0);
  /// Of elements, pressure and dead loads, without the weight [N].
  Vec3 nodal_force(int node) const {
    return dead_load.empty() ? elements.nodal_force(node) : Vec3(elements.nodal_force(node) + dead_load[node]);
  }
  double displacement_of(const Hold& hold, int axis) const {
    return hold_displacement[&hold - loads.holds.data()][axis];
  }
  void advance_explicitly(double dt, double time);
  struct Coordinate {
    Vec3 position, reference, velocity;
  };
  Vec3 resisted_change(const Point& p, const Inertance& inertance, const Vec3& f, bool follows, const Coordinate& at,
                       double dt) const;
  void move(std::size_t point, double dt);
  void advance_implicitly(double dt, double time);
  struct ImplicitStep;
  bool step_implicitly(double dt, double time, Vec3& impulse);
  void find_acceleration();
  /// Does `action(node, axis)` for each coordinate that is held rigidly.
  template <class Action>
  void for_each_rigid(const Action& action) const {
    for (std::size_t node = 0; node < x.size(); ++node) {
      for (int axis = 0; axis < 3; ++axis) {
        if (hold_of_node[node][axis] && hold_of_node[node][axis]->rigid) action(node, axis);
      }
    }
  }
  /// From positions `x` to where rigid holds have their nodes now; zero elsewhere [m].
  std::vector<Vec3> way_of_held(std::span<const Vec3> x) const;
  /// Of the elements, all loads and `body_force` on positions `x`.
  Balance balance(std::span<const Vec3> x, std::span<const Vec3> body_force);
  std::vector<Vec3> own_weight() const;
  NodalMatrix tethers() const;  ///< their stiffness [N/m]
  NodalMatrix dampers() const;
  Newton& newton();
  int relax(double time, const EquilibriumOptions& asked);
  int balance_by_newton(double time, const EquilibriumOptions& asked);
  void expect_unheld_parts_unloaded();
  [[noreturn]] void report_imbalance(double time, double residual, double tolerance);
  std::string describe(int node) const;
  std::string describe(const Newton::FreeMotion& motion) const;
  bool needs_explicit_motion() const;
  double cost_of_forces() const;
  double cost_of_newton();
  std::vector<double> fictitious_masses(const std::vector<double>& least_stiffness);
  [[noreturn]] void report_divergence(double time) const;
};

}  // namespace drogue::fem
