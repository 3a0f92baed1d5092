// SPDX-License-Identifier: GPL-3.0-or-later
// Mass across the interface of two levels. The transfer between levels matches the field, to fourth order; what the
// coarse grid lets through the interface then differs a little from what the fine grid receives. The difference is
// counted over the whole interface, and shared out among the coarse cells beside it in the course of the next coarse
// step, as density at unchanged velocity, so that mass does not drift.
//
// It is not given back where it arises, as Berger & Colella (J. Comput. Phys. 82 (1989) 64) do with fluxes. On a
// lattice of spacing dx the flux that is conserved is rho u + O(dx^2) lap(rho u), which differs between two levels also
// where the velocities are exact. That difference is free of divergence: it adds up to nothing over a closed interface,
// and is no error; taken for one it becomes a sheet of sources of second order (the wake of a sphere at Re 100 is then
// 6 % shorter, on all grids from 16 to 32 cells across).
//
// The mass that a step carries through a face needs no populations. Those with c_n = 1 add up to
// (Pi_nn + rho u_n) / 2, with Pi_ab = rho c_s^2 delta_ab + rho u_a u_b + (1 - 1/tau) Pneq_ab, so between cells a and b
//   J_n = (rho u_n(a) + rho u_n(b)) / 2 + (Pi_nn(a) - Pi_nn(b)) / 2 - d/dt (Pi_nt(a) + Pi_nt(b)) / 4,
// the flux rho u_n in the middle of the step. The last term, differences along the face in its two directions t, stands
// for diagonal populations that cross to a neighbour; it adds up to nothing over a flat interface. Where the
// interface has an edge or meets a no-slip wall, diagonal populations go other ways, and are counted one by one.
#pragma once

#include "core/archive.hpp"
#include "lbm/interface_plan.hpp"
#include "lbm/moments.hpp"
#include "lbm/stream_collide.hpp"

namespace drogue::lbm {

/// What steps of one level carry from the outer to the inner side of an interface.
template <class S>
class Crossing {
 public:
  Crossing(bool third_order, InterfaceSide side);

  const ByLeaf<InterfaceFace>& faces() const { return side_.faces; }
  /// Counts what a step from `field`, rims and boundary blocks filled, carries through the faces of one leaf: cheapest
  /// while that leaf is in the cache. Leaves may be counted in parallel.
  void count(int leaf, const MomentField<S>& field, const Relaxation& relaxation);
  /// All that the step carries across, once all leaves have been counted; in cells of rho 1.
  double total() const;

 private:
  using Real = typename S::Real;
  Vec<Real> through(const MomentField<S>& field, const InterfaceFace& face, Real keep) const;
  Vec<Real> entering(const MomentField<S>& field, const DiagonalTerm& term, Real keep) const;

  bool third_order_;
  InterfaceSide side_;
  std::vector<double> through_leaf_;
};

template <class S>
class Reflux {
 public:
  /// For the interface between `coarse` and `coarse` + 1.
  Reflux(const amr::Forest& forest, const fluid::Specification& specification, int coarse);

  Crossing<S>& of_coarse() { return coarse_; }
  Crossing<S>& of_fine() { return fine_; }
  /// To be called when all leaves have been counted.
  void end_coarse_step();
  void end_fine_step();
  /// Gives the coarse leaves of `field` what the last step has left.
  void settle(MomentField<S>& field);
  /// Mass on its way between the levels, in coarse cells of rho 1.
  double owed() const { return owed_ + counted_; }
  void transfer_state(Archive& archive);

 private:
  Reflux(bool third_order, Interface plan);

  Crossing<S> coarse_, fine_;
  int cells_ = 0;         // of coarse leaves beside the interface, once for each face
  double owed_ = 0.0;     // to them; what rounding leaves stays
  double counted_ = 0.0;  // of the coarse step at hand
};

}  // namespace drogue::lbm
