// SPDX-License-Identifier: GPL-3.0-or-later
// Domain faces: every condition is a rule that fills the layer of cells beyond the face from the layer before it, with
// the face half-way between. Mirror images conserve mass exactly:
//   free slip   u_n and the shear stresses with one normal index change sign (specular reflection)
//   no slip     u -> 2 u_wall - u (bounce-back seen from the moments)
// Open faces let sound out (lbm/radiation.hpp) or, if they are said to reflect it,
//   velocity    u -> 2 u_face - u
//   outlet      u kept, p -> 2 p_face - p
// drho and Pneq are kept where nothing else is said. Cells beyond two or three faces are mirrored once per face, walls
// last; in an edge between two faces that fix the velocity only once, which is what bounce-back does to the population
// that crosses the edge. At the edges of no-slip walls the images make a little mass, which is taken away again.
#pragma once

#include <vector>

#include "core/archive.hpp"
#include "fluid/specification.hpp"
#include "lbm/moments.hpp"
#include "lbm/radiation.hpp"

namespace drogue::lbm {

/// From SI to lattice units; the same on every level (acoustic scaling).
struct Units {
  double velocity;  ///< [m/s] of one cell per step
  double pressure;  ///< [Pa] of drho = 1: rho c_s^2
};

template <class S>
class BoundaryFill {
 public:
  BoundaryFill(const amr::Forest& forest, const fluid::Specification& specification, const Units& units);

  /// Open faces remember what has passed them: lets them take `field` for a state that has been there for ever.
  void start(int level, const MomentField<S>& field);
  /// Fills the boundary blocks of `level` at `time` [s]; leaves and ghosts of the level must be up to date.
  void operator()(int level, double time, MomentField<S>& field);
  /// Takes from the leaves of `end` the mass that edges of no-slip walls made in the step from `start`. `keep` is
  /// the share 1 - 1/tau of Pneq that survives a collision.
  void balance(int level, double keep, const MomentField<S>& start, MomentField<S>& end) const;
  void transfer_state(Archive& archive);

 private:
  using Real = typename S::Real;
  struct Item {
    int target, source, axis, face;
    int table;         // of velocities; -1 where one value does
    int memory;        // of an open face; -1 if it has none
    bool beyond_wall;  // the source is already the image in another wall
  };
  struct WallEdge {  // between two walls, at least one without slip
    int target;
    std::array<Index3, 2> outward;  // directions of the walls
  };
  using VelocityTable = std::vector<std::array<Vec<Real>, 3>>;   // per line of the layer, lattice units
  using Memory = std::array<FaceMemory<Real>, amr::block_size>;  // per line of the layer

  void add(int level, int id);
  void add_wall_edge(int level, int id, const std::vector<int>& faces);
  void update_table(const Item& item, double time);
  static Row<Real> load_layer(const std::byte* block, const Item& item, int depth, int line);
  static void store_layer(std::byte* block, const Item& item, int depth, int line, const Row<Real>& r);
  Row<Real> beyond(const Item& item, const Row<Real>& inside, int line, double ramp);
  std::array<Vec<Real>, 3> face_velocity(const Item& item, int line, double ramp) const;
  Real far_density(const Item& item) const;
  OpenFace<Real> open_face(const Item& item) const;

  const amr::Forest& forest_;
  const fluid::Specification& specification_;
  const Units units_;
  std::vector<std::vector<std::vector<Item>>> items_;  // [level][faces beyond which the block lies - 1]
  std::vector<std::vector<WallEdge>> edges_;           // [level]
  std::vector<VelocityTable> tables_;
  std::vector<Memory> memories_;
};

}  // namespace drogue::lbm
