// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "core/error.hpp"
#include "core/nearest_name.hpp"

namespace drogue::fem {
namespace {

constexpr std::array<const char*, 6> extremes{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

template <class Map>
[[noreturn]] void refuse(const std::string& what, const std::string& name, const Map& sets,
                         std::vector<std::string> known = {}) {
  for (const auto& entry : sets) known.push_back(entry.first);
  throw InputError(fmt::format("the mesh has no {} \"{}\"; expected {}{}", what, name,
                               known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", ")),
                               did_you_mean(name, known)));
}

/// Nodes on edges that belong to one surface element only.
std::vector<int> rim_nodes(const Mesh& mesh) {
  std::map<std::array<int, 2>, int> uses;
  const auto count_edges = [&](const auto& element) {
    for (std::size_t a = 0; a < element.size(); ++a) {
      const auto [low, high] = std::minmax(element[a], element[(a + 1) % element.size()]);
      ++uses[{low, high}];
    }
  };
  std::ranges::for_each(mesh.quadrilaterals, count_edges);
  std::ranges::for_each(mesh.triangles, count_edges);
  std::set<int> nodes;
  for (const auto& [edge, count] : uses) {
    if (count == 1) nodes.insert(edge.begin(), edge.end());
  }
  return {nodes.begin(), nodes.end()};
}

std::vector<int> extreme_nodes(const Mesh& mesh, int axis, bool upper) {
  const Box box = bounding_box(mesh);
  const double place = (upper ? box.upper : box.lower)[axis], tolerance = 1e-9 * box.size().maxCoeff();
  std::vector<int> nodes;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (std::abs(mesh.nodes[i][axis] - place) <= tolerance) nodes.push_back(static_cast<int>(i));
  }
  return nodes;
}

std::vector<int> every(std::size_t count) {
  std::vector<int> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

std::vector<int> look_up(const Mesh& mesh, const std::string& name, double patch) {
  if (const auto set = mesh.node_sets.find(name); set != mesh.node_sets.end()) return set->second;
  if (name == "all") return every(mesh.nodes.size());
  if (name == "corners") return corner_nodes(mesh, patch);
  if (name == "rim") return rim_nodes(mesh);
  const auto extreme = std::ranges::find(extremes, name);
  if (extreme != extremes.end()) {
    const auto side = extreme - extremes.begin();
    return extreme_nodes(mesh, static_cast<int>(side / 2), side % 2 == 1);
  }
  std::vector<std::string> known{"all", "corners", "rim"};
  known.insert(known.end(), extremes.begin(), extremes.end());
  refuse("node set", name, mesh.node_sets, known);
}

}  // namespace

std::vector<int> nodes_named(const Mesh& mesh, const std::string& name, double patch) {
  std::vector<int> nodes = look_up(mesh, name, patch);
  if (nodes.empty()) throw InputError(fmt::format("the node set \"{}\" is empty", name));
  return nodes;
}

ElementSet elements_named(const Mesh& mesh, const std::string& name) {
  if (name.empty()) {
    return {every(mesh.hexahedra.size()), every(mesh.quadrilaterals.size()), every(mesh.triangles.size()),
            every(mesh.lines.size())};
  }
  const auto set = mesh.element_sets.find(name);
  if (set == mesh.element_sets.end()) refuse("region", name, mesh.element_sets);
  return set->second;
}

std::vector<int> corner_nodes(const Mesh& mesh, double patch) {
  if (mesh.nodes.empty()) return {};
  const Box box = bounding_box(mesh);
  const double reach = patch + 1e-9 * box.size().maxCoeff();
  std::vector<int> nodes;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3 distance = (mesh.nodes[i] - box.lower).cwiseMin(box.upper - mesh.nodes[i]);
    if (distance.maxCoeff() <= reach) nodes.push_back(static_cast<int>(i));
  }
  return nodes;
}

Box bounding_box(const Mesh& mesh) {
  Box box{mesh.nodes.front(), mesh.nodes.front()};
  for (const Vec3& node : mesh.nodes) {
    box.lower = box.lower.cwiseMin(node);
    box.upper = box.upper.cwiseMax(node);
  }
  return box;
}

int node_nearest(const Mesh& mesh, const Vec3& place) {
  const auto nearest =
      std::ranges::min_element(mesh.nodes, {}, [&](const Vec3& x) { return (x - place).squaredNorm(); });
  return static_cast<int>(nearest - mesh.nodes.begin());
}

}  // namespace drogue::fem
