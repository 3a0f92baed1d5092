// SPDX-License-Identifier: GPL-3.0-or-later
// Sheets: solids one hexahedron thick, whose nodes face each other, and surfaces.
#pragma once

#include "fem/mesh.hpp"

namespace drogue::fem {

/// Pairs of nodes that face each other through a solid one element thick and at most `max_thickness` [m] thick.
std::vector<std::array<int, 2>> thickness_pairs(const Mesh& mesh, double max_thickness);

/// Faces that belong to one hexahedron only, in order around.
std::vector<std::array<int, 4>> outer_faces(const Mesh& mesh);

/// Area [m^2] of the mid-surface that belongs to each pair: the mean of the two faces' lumped areas.
std::vector<double> pair_areas(const Mesh& mesh, const std::vector<std::array<int, 2>>& pairs);

/// Normal of the surface elements around each node, weighted with their area, not normalised; zero of nodes without.
std::vector<Vec3> area_normals(const Mesh& mesh);

}  // namespace drogue::fem
