// SPDX-License-Identifier: GPL-3.0-or-later
// The points through which a solid and the fluid meet. Where the solid is thinner than the grid spacing the two nodes
// that face each other are one point, a marker of a sheet; every other node is a point of its own: a marker of the
// cloud that fills the solid, of the layer that is a membrane, or of the line that is a cable. With a single phase of
// fluid filling all space, the solid adds only what its mass exceeds the fluid's by. Nodes whose regions are all
// uncoupled meet no fluid, displace none and carry their own mass.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "fem/structure.hpp"
#include "ib/delta.hpp"

namespace drogue::fsi {

struct CoupledPoints {
  std::vector<std::array<int, 2>> nodes;  ///< {a, -1} or {a, b}
  std::vector<double> excess_mass;        ///< own mass less that of the fluid displaced [kg]
  std::vector<double> dragged_mass;       ///< of fluid (ib/dragged_mass.hpp) [kg]
  std::vector<Vec3> normal;               ///< of a sheet in the reference position, all towards one side; zero without

  int size() const { return static_cast<int>(nodes.size()); }
};

/// The points, and after them every uncoupled node on its own, with the masses that they move. The faces of a pair move
/// against each other with their own mass, or that of the fluid of `density` [kg/m^3] in their place if it is more, so
/// that a sheet may be massless.
fem::Inertia inertia_of(const fem::Structure& structure, const CoupledPoints& points, double density);

/// For a fluid of `density` [kg/m^3] on a grid of `spacing` [m]. Throws InputError, naming `body` and the node, where
/// the solid is so light that the scheme would be unstable (half the fluid's density, for a thick one), or if nothing
/// is coupled.
CoupledPoints couple_points(const fem::Structure& structure, ib::Delta delta, double spacing, double density,
                            const std::string& body);

/// Every node on its own, in the order of the nodes; those of a pair share its masses.
CoupledPoints split_into_nodes(const CoupledPoints& points);

}  // namespace drogue::fsi
