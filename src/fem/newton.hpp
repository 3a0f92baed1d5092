// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method for the balance of forces of a body.
//
// The tangent of a sheet that starts flat, of a slack cable or of a wrinkled membrane is singular, and far from balance
// it may be indefinite. It is then damped, (K + B + mu D) u = f, with D the diagonal that exceeds the elements'
// stiffness (Levenberg 1944; pseudo-transient continuation), mu as small as makes it positive definite and steps
// succeed, and none at the end. A step is shortened until the forces' work along it, f . u, no longer is so much less
// than zero that it went far past the balance (Matthies & Strang, Int. J. Numer. Methods Eng. 14 (1979) 1613); work,
// unlike energy, is known of follower loads as well. The forces left may rise in a step: a slender beam first leaves
// the narrow valley of its energy and then returns.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "fem/sparse_system.hpp"

namespace drogue::fem {

/// Of all forces on a body.
struct Balance {
  std::vector<Vec3> left;  ///< on each node, zero along what is held rigidly [N]
  Vec3 reaction;           ///< of all holds on the body [N]
  double scale;            ///< norm of all loads and reactions [N]
  bool inside;             ///< whether the elements are within their bounds of J
};

double norm(std::span<const Vec3> field);
/// s a + t b
std::vector<Vec3> combined(double s, std::span<const Vec3> a, double t, std::span<const Vec3> b);

class Newton {
 public:
  using Forces = std::function<Balance(std::span<const Vec3> x)>;
  struct Outcome {
    bool balanced;
    int iterations;
    double residual;  ///< norm of the forces left over that of loads and reactions
  };
  /// A motion that hardly anything resists, and the node that moves most in it.
  struct FreeMotion {
    int node;
    Vec3 direction;
  };

  /// `elements` outlive it; `damping` is D [N/m].
  Newton(Elements& elements, const SparseSystem::Held& held, std::span<const NodalMatrix::Pair> pairs,
         std::vector<double> damping);

  /// Moves `x`, along what is held by `prescribed`, until the forces balance up to `tolerance`. Their derivative is
  /// minus that of the elements and of `added`.
  Outcome solve(std::vector<Vec3>& x, const std::vector<Vec3>& prescribed, const Forces& forces,
                const NodalMatrix& added, double tolerance);

  /// By inverse iteration at positions `x`.
  std::optional<FreeMotion> find_free_motion(std::span<const Vec3> x, const NodalMatrix& added);

  /// Multiplications of a factorisation.
  double operations() const { return system_.operations(); }

 private:
  bool move_held(std::vector<Vec3>& x, const std::vector<Vec3>& prescribed, Balance& balance, const Forces& forces,
                 const NodalMatrix& added);
  bool improve(std::vector<Vec3>& x, Balance& balance, const Forces& forces, const NodalMatrix& added);
  std::vector<Vec3> step_against(const std::vector<Vec3>& force, const NodalMatrix& added);
  bool factorise(const NodalMatrix& added);
  double rounding_of_forces(std::span<const Vec3> x, const NodalMatrix& added) const;

  Elements& elements_;
  TangentStiffness stiffness_;
  SparseSystem system_;
  std::vector<double> damping_;
  double mu_ = 0.0;
};

}  // namespace drogue::fem
