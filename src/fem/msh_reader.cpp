// SPDX-License-Identifier: GPL-3.0-or-later
// Takes first-order hexahedra, quadrangles, triangles and lines from a gmsh file; gmsh numbers their nodes as VTK does.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <unordered_map>

#include "core/error.hpp"
#include "fem/mesh.hpp"
#include "geometry/msh_file.hpp"

namespace drogue::fem {
namespace {

using geometry::MshBlock;
using geometry::MshContent;

class Reader {
 public:
  explicit Reader(const MshContent& content) : content_(content) {}

  /// Elements of one type; nodes are numbered in the order in which elements first name them.
  template <std::size_t N>
  void take(int type, Cells<N>& cells, std::vector<int> ElementSet::*family) {
    for (const MshBlock& block : content_.blocks) {
      if (block.type != type) continue;
      const int first = static_cast<int>(cells.size());
      for (std::size_t i = 0; i < block.tags.size(); i += N) {
        auto& element = cells.emplace_back();
        for (std::size_t a = 0; a < N; ++a) element[a] = number(block.tags[i + a], block);
      }
      for (const std::string& name : groups_of(block)) {
        auto& set = mesh.element_sets[name].*family;
        for (int e = first; e < static_cast<int>(cells.size()); ++e) set.push_back(e);
      }
    }
  }

  void take_node_sets() {
    for (const MshBlock& block : content_.blocks) {
      for (const std::string& name : groups_of(block)) {
        for (const std::uint64_t tag : block.tags) {
          if (const auto node = numbers_.find(tag); node != numbers_.end())
            mesh.node_sets[name].push_back(node->second);
        }
      }
    }
    for (auto& [name, nodes] : mesh.node_sets) {
      std::ranges::sort(nodes);
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    }
  }

  Mesh mesh;

 private:
  int number(std::uint64_t tag, const MshBlock& block) {
    const Vec3& position = content_.position_of(tag, block);
    const auto [entry, is_new] = numbers_.try_emplace(tag, static_cast<int>(mesh.nodes.size()));
    if (is_new) mesh.nodes.push_back(position);
    return entry->second;
  }

  std::vector<std::string> groups_of(const MshBlock& block) const {
    std::vector<std::string> names;
    const auto found = content_.groups.find({block.dimension, block.entity});
    if (found == content_.groups.end()) return names;
    for (const int group : found->second) {
      const auto name = content_.group_name.find({block.dimension, group});
      names.push_back(name == content_.group_name.end() ? std::to_string(group) : name->second);
    }
    return names;
  }

  const MshContent& content_;
  std::unordered_map<std::uint64_t, int> numbers_;
};

void refuse_unusable(const MshContent& content) {
  constexpr std::array<const char*, 4> entity{"point", "line", "surface", "volume"};
  constexpr std::array usable{geometry::msh_point, geometry::msh_line, geometry::msh_triangle, geometry::msh_quadrangle,
                              geometry::msh_hexahedron};
  for (const MshBlock& block : content.blocks) {
    if (std::ranges::find(usable, block.type) != usable.end()) continue;
    throw InputError(
        fmt::format("{}: {} {} has elements of type {}; expected hexahedra with eight nodes (type 5), "
                    "quadrangles with four (3), triangles with three (2) or lines with two (1)",
                    content.file, entity[block.dimension], block.entity, block.type));
  }
}

}  // namespace

Mesh read_msh(const std::filesystem::path& file) {
  const MshContent content = geometry::read_msh_content(file);
  refuse_unusable(content);
  Reader reader(content);
  reader.take(geometry::msh_hexahedron, reader.mesh.hexahedra, &ElementSet::hexahedra);
  reader.take(geometry::msh_quadrangle, reader.mesh.quadrilaterals, &ElementSet::quadrilaterals);
  reader.take(geometry::msh_triangle, reader.mesh.triangles, &ElementSet::triangles);
  reader.take(geometry::msh_line, reader.mesh.lines, &ElementSet::lines);
  if (reader.mesh.nodes.empty()) {
    throw InputError(
        fmt::format("{}: no elements; expected hexahedra, quadrangles, triangles or lines", file.string()));
  }
  reader.take_node_sets();
  return reader.mesh;
}

}  // namespace drogue::fem
