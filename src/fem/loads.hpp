// SPDX-License-Identifier: GPL-3.0-or-later
// What acts on a body besides its elements.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/expression.hpp"
#include "core/types.hpp"

namespace drogue::fem {

/// Holds nodes near their reference position X, or where `displacement` u(t) takes them: force per reference volume
/// kappa (X + u - x) - eta v (paper eq. 11), or, if `rigid`, x = X + u (the limit of large kappa; without displacement,
/// zero velocity). Along the axes that are held only.
struct Hold {
  std::vector<int> nodes;
  bool rigid = false;
  double stiffness = 0.0;  ///< kappa [N/m^4]
  double damping = 0.0;    ///< eta [N s/m^4]
  bool hinged = false;     ///< pairs of nodes, see Inertia, may turn about their middle; for explicit motion
  std::array<bool, 3> axes{true, true, true};
  std::array<Expression, 3> displacement{};  ///< of time alone [m]

  bool moves() const;
  bool stands_still() const { return rigid && !moves(); }
};

/// Three formulas of time.
Vec3 at(const std::array<Expression, 3>& formula, double time);
bool vary(const std::array<Expression, 3>& formula);

struct PointMass {
  int node = 0;
  double mass = 0.0;  ///< [kg]
};

/// Pressure on the quadrilaterals and triangles of a set of the mesh (all of them if empty), which pushes towards the
/// side from which their nodes appear in counter-clockwise order.
struct Pressure {
  std::string elements;
  Expression pressure;  ///< of time alone [Pa]
};

/// A dead load, shared among nodes by their reference volumes.
struct NodeLoad {
  std::vector<int> nodes;
  std::array<Expression, 3> force{};  ///< of time alone [N], in all
};

struct Loads {
  std::vector<Hold> holds;
  std::vector<NodeLoad> forces;
  std::vector<PointMass> masses;
  std::vector<Pressure> pressures;
  Vec3 gravity = Vec3::Zero();     ///< [m/s^2]
  double damping = 0.0;            ///< Rayleigh's factor of the own mass [1/s]
  double stiffness_damping = 0.0;  ///< Rayleigh's factor of the stiffness of the elements [s]
};

}  // namespace drogue::fem
