// SPDX-License-Identifier: GPL-3.0-or-later
// Domain faces: every condition is a rule that fills the layer of cells beyond the face from the layer before it, with
// the face half-way between. Mirror images conserve mass exactly:
//   free slip   u_n and the shear stresses with one normal index change sign (specular reflection)
//   no slip     u -> 2 u_wall - u (bounce-back seen from the moments)
// Open faces let sound out (lbm/radiation.hpp) or, if they are said to reflect it,
//   velocity    u -> 2 u_face - u
//   outlet      u kept, p -> 2 p_face - p
// drho and Pneq are kept where nothing else is said. Cells beyond two faces are mirrored once per face, walls last; in
// an edge between two faces that fix the velocity only once, which is what bounce-back does to the population that
// crosses the edge. No population crosses a corner. At the edges of no-slip walls the images make a little mass, which
// is taken away again.
#pragma once

#include <array>
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
  using Velocity = std::array<Vec<Real>, 3>;  // of a line, lattice units
  using Memory = std::array<FaceMemory<Real>, amr::block_size>;
  /// Where the first line of some lies in a block, for MomentField::load_line().
  struct Place {
    int block;
    Index3 first;
    bool in_columns;
  };
  /// The lines of one block that are images in one face: 16 next to it, or the one in an edge between two faces.
  struct Item {
    Place from;
    int to;  // block, whose lines begin at
    Index3 to_first;
    int along, across, count;  // axes along and across the lines
    int face;
    int table;         // of velocities; -1 where one value does
    int memory;        // of an open face; -1 if it has none
    bool beyond_wall;  // `from` is already the image in another wall
    Velocity velocity;
    Real density;         // beyond an outlet
    OpenFace<Real> open;  // if `memory` is there
  };
  /// A line of cells, and which of its populations crosses an edge.
  struct Sender {
    Place place;
    Index3 direction;
  };
  struct WallEdge {  // between two walls o and p, at least one without slip
    int along;
    std::array<Sender, 4> sender;  // beyond neither, p, o, both
  };

  void add(int level, int id);
  void add_wall_edge(int level, int id, const std::vector<int>& faces);
  Item item_at(int id, const std::vector<int>& faces) const;
  void update_table(const Item& item, double time);
  Row<Real> beyond(const Item& item, const Row<Real>& inside, int line, Real ramp);

  const amr::Forest& forest_;
  const fluid::Specification& specification_;
  const Units units_;
  std::vector<std::array<std::vector<Item>, 2>> items_;  // [level][faces beyond which the block lies - 1]
  std::vector<std::vector<WallEdge>> edges_;             // [level]
  std::vector<std::array<Velocity, amr::block_size>> tables_;
  std::vector<Memory> memories_;
};

}  // namespace drogue::lbm
