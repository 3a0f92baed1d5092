// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/region.hpp"

#include <set>

namespace drogue::fem {

ElementSet elements_of(const Mesh& mesh, const Region& region) {
  ElementSet set = elements_named(mesh, region.elements);
  if (!std::holds_alternative<Solid>(region.kind)) set.hexahedra.clear();
  if (!std::holds_alternative<Cable>(region.kind)) set.lines.clear();
  if (!std::holds_alternative<Membrane>(region.kind)) {
    set.quadrilaterals.clear();
    set.triangles.clear();
  }
  return set;
}

std::vector<int> nodes_of(const Mesh& mesh, const Region& region) {
  const ElementSet set = elements_of(mesh, region);
  std::set<int> nodes;
  const auto add = [&nodes](const auto& cells, const std::vector<int>& elements) {
    for (const int e : elements) nodes.insert(cells[e].begin(), cells[e].end());
  };
  add(mesh.hexahedra, set.hexahedra);
  add(mesh.quadrilaterals, set.quadrilaterals);
  add(mesh.triangles, set.triangles);
  add(mesh.lines, set.lines);
  return {nodes.begin(), nodes.end()};
}

}  // namespace drogue::fem
