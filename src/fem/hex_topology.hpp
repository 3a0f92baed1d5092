// SPDX-License-Identifier: GPL-3.0-or-later
// Corners and edges of an eight-node hexahedron in VTK's numbering, whose parent is the cube [-1, 1]^3.
#pragma once

namespace drogue::fem {

/// The corner at which a node lies: bit d for the side xi_d > 0.
inline constexpr int corner_of_node[8] = {0, 1, 3, 2, 4, 5, 7, 6};

/// First and last node of the four edges along each parent direction. An edge's place is that along the two other
/// directions, 0 or 1 each, the lower one counting 1 and the higher one 2.
inline constexpr int hex_edge[3][4][2] = {
    {{0, 1}, {3, 2}, {4, 5}, {7, 6}}, {{0, 3}, {1, 2}, {4, 7}, {5, 6}}, {{0, 4}, {1, 5}, {3, 7}, {2, 6}}};

/// +-1/sqrt(3): the Gauss points of [-1, 1].
inline constexpr double gauss_abscissa = 0.57735026918962576451;

}  // namespace drogue::fem
