// SPDX-License-Identifier: GPL-3.0-or-later
// An elastic body of solids, membranes and cables: total Lagrangian, lumped masses, explicit in time with as many
// sub-steps as stability asks for, or at rest. SI, double precision. Knows nothing of a fluid; what surrounds it
// enters as `Inertia`.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/archive.hpp"
#include "core/types.hpp"
#include "fem/loads.hpp"
#include "fem/mesh.hpp"
#include "fem/region.hpp"

namespace drogue::fem {

/// Points that move as one: a node, or the two nodes of a pair through the thickness of a thin solid. A point's mean
/// velocity carries `mass`, the difference of a pair the reduced mass m_a m_b / (m_a + m_b) of its faces. Means are
/// weighted with these masses (halves, where the two faces are alike), so that the two motions do not exchange energy.
struct Inertia {
  std::vector<std::array<int, 2>> point;  ///< {a, -1} or {a, b}; every node in exactly one point
  std::vector<double> mass;               ///< [kg] of the mean motion
  std::vector<double> heavy_mass;         ///< [kg] on which gravity acts
  std::vector<double> face_mass;          ///< [kg] of every node; read of those in pairs
  double reset = 1.0;  ///< in (-1, 1]: least factor by which means' velocities are multiplied between advances
};

enum class Integrator { explicit_scheme, implicit_scheme, cheaper };

struct StructureOptions {
  double dissipation =
      0.2;              ///< phi - 1 of the Tchamwa-Wielgosz scheme, in [0, 0.5): damps what a sub-step barely resolves
  double safety = 0.9;  ///< share of the stable step that is used
  std::array<double, 2> volume_ratio{0.05, 20.0};  ///< bounds of J at the Gauss points; beyond them Diverged is thrown
  Integrator integrator = Integrator::explicit_scheme;
  double spectral_radius = 0.8;  ///< of the implicit scheme for what it does not resolve, from 0 (all damped) to 1
};

enum class Equilibrium { cheaper, relaxation, newton };

/// Of Structure::find_equilibrium().
struct EquilibriumOptions {
  Equilibrium method = Equilibrium::cheaper;
  double tolerance = 1e-6;        ///< largest norm of the forces left, over that of the loads and reactions
  int most_iterations = 200'000;  ///< of relaxation
};

/// What a structure is made from.
struct Model {
  Mesh mesh;
  std::vector<Region> regions;
  Loads loads;
  StructureOptions options;
};

/// A body whose hexahedra are all of one material, of `density` [kg/m^3].
Model one_solid(Mesh mesh, const Material& material, double density, std::vector<Hold> holds = {},
                const StructureOptions& options = {});

class Structure {
 public:
  /// Throws InputError for what Elements refuses, a node held twice along an axis, or an option out of range.
  explicit Structure(Model model);
  ~Structure();
  Structure(Structure&&) noexcept;

  const Mesh& mesh() const;
  int elements() const;                            ///< number of them, of all regions
  std::span<const Vec3> position() const;          ///< [m] per node
  std::span<const Vec3> velocity() const;          ///< [m/s] per node
  std::span<const double> own_mass() const;        ///< [kg] per node: lumped from the elements, and point masses
  std::span<const double> volume() const;          ///< [m^3] lumped reference volume per node
  std::span<const double> coupled_volume() const;  ///< [m^3] the part of it in coupled regions
  void set_state(std::span<const Vec3> position, std::span<const Vec3> velocity);

  /// Replaces the default inertia (every node a point of its own mass), as it must before a body that is massless
  /// somewhere can move. Throws InputError for a mass that is not positive, a node not in exactly one point, a pair
  /// whose nodes are not held alike, or a hinge of a node alone.
  void set_inertia(Inertia inertia);
  const Inertia& inertia() const;
  /// Shifts both nodes of a point so that their mean velocity becomes `v` [m/s]; differences are kept.
  void set_mean_velocity(int point, const Vec3& v);
  Vec3 mean_position(int point) const;
  Vec3 mean_velocity(int point) const;

  /// Integrates over `dt` [s] from `time` [s] on, in sub-steps; throws Diverged (naming element, J, place) for a volume
  /// ratio out of bounds, or if forces do not balance.
  void advance(double dt, double time);
  /// Which scheme advance() uses for steps of `dt` [s]: that of the options, or what is cheaper by an estimate from
  /// counts, of the body as it was when its inertia was set.
  Integrator integrator_for(double dt) const;
  /// Finds the equilibrium under the loads of `time` [s], from where the structure is, and leaves it there at rest.
  /// Points, their masses and damping do not matter. Returns the number of iterations; throws Diverged if it is not
  /// found, naming what moves unheld, or if an element is torn.
  int find_equilibrium(double time, const EquilibriumOptions& options);
  /// A motion that nothing resists at the equilibrium that Newton's method found last, in words; empty if there is
  /// none.
  const std::string& free_motion() const;
  /// What is cheaper by an estimate from counts.
  Equilibrium cheaper_equilibrium() const;
  int substeps() const;                       ///< taken by the last advance, or iterations to the last equilibrium
  double explicit_substeps(double dt) const;  ///< in an explicit advance over `dt` [s] from here
  double stable_step() const;        ///< [s] longest sub-step of the scheme, safety included, for largest_frequency()
  double largest_frequency() const;  ///< [rad/s] upper estimate from the elements as deformed, behind the sub-step

  /// Nodal forces of the elements [N] (minus the gradient of the energy) at the given positions.
  void internal_force(std::span<const Vec3> position, std::span<Vec3> force) const;
  /// Adds the forces of the tethers [N]; rigid holds have none, their nodes must be kept where they are.
  void add_hold_force(std::span<const Vec3> position, std::span<const Vec3> velocity, std::span<Vec3> force) const;
  bool is_held_rigidly(int node) const;              ///< along every axis
  Vec3 reaction() const;                             ///< [N] mean force of all holds on the body over the last advance
  double elastic_energy() const;                     ///< [J]
  double kinetic_energy() const;                     ///< [J] with the point and difference masses in use
  std::array<double, 2> volume_ratio_range() const;  ///< smallest and largest J at the Gauss points now
  /// Root mean square over pairs of the velocity difference of the two faces [m/s], along the line that joins them
  /// (thickness change) and in full; zeros without pairs.
  std::array<double, 2> face_velocity_difference() const;
  double mean_thickness_stretch() const;  ///< mean over pairs of current over reference distance; 1 without
  /// How far a thin solid is from plane stress: mean over its elements of the thickness stretch that would free their
  /// faces of stress, and the root mean square of the relative difference of the one they have. {1, 0} without pairs.
  std::array<double, 2> plane_stress_comparison() const;

  /// Saves or restores positions and velocities. Throws InputError if those saved are of another mesh.
  void transfer_state(Archive& archive);

  /// For TouchingStructures alone.
  struct Data;
  Data& data() { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

}  // namespace drogue::fem
