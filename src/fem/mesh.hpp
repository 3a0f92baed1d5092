// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes of solids, sheets and lines with named sets. What an element is made of is said by a Region, not here.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace drogue::fem {

/// Elements with N nodes each.
template <std::size_t N>
using Cells = std::vector<std::array<int, N>>;

/// Numbers of elements, family by family.
struct ElementSet {
  std::vector<int> hexahedra, quadrilaterals, triangles, lines;
};

struct Mesh {
  std::vector<Vec3> nodes;  ///< reference positions [m]
  Cells<8> hexahedra;       ///< VTK order: bottom face counter-clockwise, then top face
  Cells<4> quadrilaterals;  ///< in order around
  Cells<3> triangles;
  Cells<2> lines;
  std::map<std::string, std::vector<int>> node_sets;
  std::map<std::string, ElementSet> element_sets;
};

/// Reads a gmsh 4.1 file (ASCII or binary) with physical groups as sets. Throws InputError naming file and line or
/// entity.
Mesh read_msh(const std::filesystem::path& file);

/// Nodes of a set: one that the mesh names, or "all", "corners" (with `patch`, see corner_nodes()), "rim" (of a
/// surface) or one of "x_min" to "z_max", the nodes furthest that way. Throws InputError for an unknown or an empty
/// one.
std::vector<int> nodes_named(const Mesh& mesh, const std::string& name, double patch = 0.0);

/// Elements of a set that the mesh names, or all of them if `name` is empty. Throws InputError for an unknown one.
ElementSet elements_named(const Mesh& mesh, const std::string& name);

/// Nodes whose distance from one of the four corners of the mesh's bounding rectangle (the eight corners of its box) is
/// at most `patch` [m] along each axis; with `patch` 0 the corner nodes alone.
std::vector<int> corner_nodes(const Mesh& mesh, double patch);

Box bounding_box(const Mesh& mesh);

/// The node nearest to `place` [m]; the first of equals.
int node_nearest(const Mesh& mesh, const Vec3& place);

}  // namespace drogue::fem
