// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes of eight-node hexahedra with named sets.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace drogue::fem {

struct HexMesh {
  std::vector<Vec3> nodes;                   ///< reference positions [m]
  std::vector<std::array<int, 8>> elements;  ///< VTK order: bottom face counter-clockwise, then top face
  std::map<std::string, std::vector<int>> node_sets;
  std::map<std::string, std::vector<int>> element_sets;
};

/// A rectangular plate: `normal` is the axis (0, 1, 2) it is thin in; `size` along the two other axes in cyclic order.
struct PlateDescription {
  Vec3 centre = Vec3::Zero();  ///< of the mid-surface [m]
  int normal = 0;
  std::array<double, 2> size{};          ///< [m]
  double thickness = 0.0;                ///< [m]
  std::array<int, 3> elements{1, 1, 1};  ///< along the two sides, through the thickness
};
HexMesh make_plate(const PlateDescription& plate);

/// Reads hexahedra of a gmsh 4.1 file (ASCII or binary) with physical groups as sets. Throws InputError naming file and
/// line or entity.
HexMesh read_msh(const std::filesystem::path& file);

/// Nodes whose distance from one of the four corners of the mesh's bounding rectangle (the eight corners of its box) is
/// at most `patch` [m] along each axis; with `patch` 0 the corner nodes alone.
std::vector<int> corner_nodes(const HexMesh& mesh, double patch);

/// Pairs of nodes that face each other through a solid one element thick and at most `max_thickness` [m] thick.
std::vector<std::array<int, 2>> thickness_pairs(const HexMesh& mesh, double max_thickness);

/// Area [m^2] of the mid-surface that belongs to each pair: the mean of the two faces' lumped areas.
std::vector<double> pair_areas(const HexMesh& mesh, const std::vector<std::array<int, 2>>& pairs);

}  // namespace drogue::fem
