// SPDX-License-Identifier: GPL-3.0-or-later
// Takes the hexahedra from a gmsh file; gmsh numbers their nodes as VTK does.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <unordered_map>

#include "core/error.hpp"
#include "fem/hex_mesh.hpp"
#include "geometry/msh_file.hpp"

namespace drogue::fem {
namespace {

/// Numbers the nodes of hexahedra in the order in which elements first name them.
class Numbering {
 public:
  int number(std::uint64_t tag) { return numbers_.try_emplace(tag, static_cast<int>(numbers_.size())).first->second; }
  /// -1 for a node of no hexahedron.
  int find(std::uint64_t tag) const {
    const auto found = numbers_.find(tag);
    return found == numbers_.end() ? -1 : found->second;
  }

 private:
  std::unordered_map<std::uint64_t, int> numbers_;
};

[[noreturn]] void refuse(const geometry::MshContent& content, const geometry::MshBlock& block) {
  throw InputError(
      fmt::format("{}: volume {} has elements of type {}; expected hexahedra with eight nodes (type 5) alone",
                  content.file, block.entity, block.type));
}

}  // namespace

HexMesh read_msh(const std::filesystem::path& file) {
  const geometry::MshContent content = geometry::read_msh_content(file);
  const auto sets_of = [&](const geometry::MshBlock& block) {
    std::vector<std::string> names;
    const auto found = content.groups.find({block.dimension, block.entity});
    if (found == content.groups.end()) return names;
    for (const int group : found->second) {
      const auto name = content.group_name.find({block.dimension, group});
      names.push_back(name == content.group_name.end() ? std::to_string(group) : name->second);
    }
    return names;
  };

  HexMesh mesh;
  Numbering numbering;
  for (const geometry::MshBlock& block : content.blocks) {
    if (block.type != geometry::msh_hexahedron) {
      if (block.dimension == 3) refuse(content, block);
      continue;
    }
    const int first = static_cast<int>(mesh.elements.size());
    for (std::size_t i = 0; i < block.tags.size(); i += 8) {
      auto& element = mesh.elements.emplace_back();
      for (int a = 0; a < 8; ++a) {
        const Vec3& position = content.position_of(block.tags[i + a], block);
        element[a] = numbering.number(block.tags[i + a]);
        if (element[a] == static_cast<int>(mesh.nodes.size())) mesh.nodes.push_back(position);
      }
    }
    for (const std::string& name : sets_of(block)) {
      for (int e = first; e < static_cast<int>(mesh.elements.size()); ++e) mesh.element_sets[name].push_back(e);
    }
  }
  if (mesh.elements.empty())
    throw InputError(fmt::format("{}: no hexahedra; expected elements of type 5", file.string()));

  for (const geometry::MshBlock& block : content.blocks) {
    for (const std::string& name : sets_of(block)) {
      for (const std::uint64_t tag : block.tags) {
        if (const int node = numbering.find(tag); node >= 0) mesh.node_sets[name].push_back(node);
      }
    }
  }
  for (auto& [name, nodes] : mesh.node_sets) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  return mesh;
}

}  // namespace drogue::fem
