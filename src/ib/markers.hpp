// SPDX-License-Identifier: GPL-3.0-or-later
// Interpolation and spreading between markers and the finest grid level. They are adjoint,
//   sum_x u . S[F] dx^3 = sum_l I[u]_l . F_l,
// and give the same bits for any number of threads: interpolation writes per marker, spreading per block, each in a
// fixed order. Weights and sums are double, grid values float. Periodic axes wrap.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "fluid/fluid_solver.hpp"
#include "ib/delta.hpp"
#include "ib/stencil.hpp"

namespace drogue::ib {

class Markers {
 public:
  /// `body` names the owner in error messages. The forest must outlive the markers and keep its blocks.
  Markers(const amr::Forest& forest, Delta delta, std::string body);

  /// Moves the markers to `position` [m]; throws InputError if one does not lie in finest-level blocks with the delta's
  /// margin, naming it.
  void move_to(std::span<const Vec3> position);
  int size() const { return static_cast<int>(stencils_.size()); }

  /// U_l = sum_x u(x) delta(x - X_l) dx^3 [m/s].
  void interpolate(const fluid::VelocityView& u, std::span<Vec3> out) const;
  /// The same for a force density [N/m^3]; blocks that are not open count as zero.
  void interpolate(const fluid::ForceField& f, std::span<Vec3> out) const;
  /// The same for u* + kappa f [m/s], the velocity with the forces spread so far.
  void interpolate(const fluid::FineStep& step, std::span<Vec3> out) const;
  /// f(x) += sum_l F_l delta(x - X_l), F_l in [N]; opens the blocks it needs.
  void spread(std::span<const Vec3> force, fluid::ForceField& f) const;

 private:
  enum class Placement { kept, changed, lost };
  struct Touch {
    int marker, side;
  };

  Placement place(const Vec3& position, Stencil& stencil) const;
  bool find_blocks(Stencil& stencil) const;
  void group_by_block();
  [[noreturn]] void throw_lost(int marker, const Vec3& position) const;

  const amr::Forest* forest_;
  Delta delta_;
  std::string body_;
  double spacing_;  // of the finest level [m]
  Index3 cells_;    // of the finest level across the domain
  std::vector<Stencil> stencils_;
  std::vector<int> blocks_;     // touched by any marker, in the order of the first
  std::vector<int> slot_;       // block id -> its place in blocks_
  std::vector<int> first_;      // blocks_[i] is touched by touches_[first_[i]] .. touches_[first_[i + 1] - 1]
  std::vector<Touch> touches_;  // within a block in the order of the markers
};

}  // namespace drogue::ib
