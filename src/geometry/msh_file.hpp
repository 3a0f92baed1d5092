// SPDX-License-Identifier: GPL-3.0-or-later
// What a gmsh 4.1 mesh file holds, before anybody asks for hexahedra or for triangles.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/types.hpp"

namespace drogue::geometry {

struct MshBlock {
  int dimension, entity, type;
  std::vector<std::uint64_t> tags;  ///< node tags of its elements, one element after the other
};

struct MshContent {
  std::string file;
  std::map<std::array<int, 2>, std::string> group_name;   ///< of {dimension, group}
  std::map<std::array<int, 2>, std::vector<int>> groups;  ///< of {dimension, entity}
  std::unordered_map<std::uint64_t, Vec3> position;       ///< by node tag [m]
  std::vector<MshBlock> blocks;

  /// Throws InputError if the file does not define the node that the block uses.
  const Vec3& position_of(std::uint64_t tag, const MshBlock& block) const;
};

/// gmsh's types of elements that are used somewhere.
inline constexpr int msh_line = 1, msh_triangle = 2, msh_quadrangle = 3, msh_hexahedron = 5, msh_point = 15;

/// Reads a file in ASCII or binary. Throws InputError naming file and line.
MshContent read_msh_content(const std::filesystem::path& file);

}  // namespace drogue::geometry
