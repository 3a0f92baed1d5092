// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles in space, the files they come from, and the solid they enclose.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "core/types.hpp"

namespace drogue::geometry {

struct TriangleMesh {
  std::vector<Vec3> points;                   ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise seen from outside
};

struct Solid {
  double volume = 0.0;          ///< [m^3]
  Vec3 centre = Vec3::Zero();   ///< of the volume; of the area where there is none [m]
  Mat3 inertia = Mat3::Zero();  ///< about the centre, per density [m^5]
};

/// Reads `.stl`, ASCII or binary, or the triangles and quadrangles of a gmsh 4.1 `.msh`; coordinates are metres.
/// Coinciding points become one; a closed surface that looks inwards is turned. Throws InputError naming file and line.
TriangleMesh read_triangles(const std::filesystem::path& file);

/// Whether every edge is shared by two triangles. Throws InputError if it is, but they are not oriented alike.
bool is_closed(const TriangleMesh& mesh);

/// What the mesh encloses if it is closed; else the centre of its area alone. The volume is negative if the triangles
/// look inwards.
Solid solid_of(const TriangleMesh& mesh);

}  // namespace drogue::geometry
