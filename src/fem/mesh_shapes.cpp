// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/mesh_shapes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace drogue::fem {
namespace {

void expect_elements(const std::string& what, std::initializer_list<int> counts) {
  for (const int count : counts) {
    if (count >= 1) continue;
    throw InputError(
        fmt::format("the {} has {} elements; expected at least one each way", what, fmt::join(counts, " x ")));
  }
}

void expect_axis(const std::string& what, int axis) {
  if (axis >= 0 && axis <= 2) return;
  throw InputError(fmt::format("the {}'s normal is axis {}; expected 0, 1 or 2", what, axis));
}

void halve(Mesh& mesh) {
  for (const auto& [a, b, c, d] : mesh.quadrilaterals) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  mesh.quadrilaterals.clear();
}

}  // namespace

Mesh make_plate(const PlateDescription& plate) {
  const auto& [along_1, along_2, through] = plate.elements;
  expect_axis("plate", plate.normal);
  if (!(plate.size[0] > 0.0 && plate.size[1] > 0.0 && plate.thickness > 0.0)) {
    throw InputError(fmt::format("the plate measures {} x {} x {} m; expected positive lengths", plate.size[0],
                                 plate.size[1], plate.thickness));
  }
  expect_elements("plate", {along_1, along_2, through});
  const int axis_1 = (plate.normal + 1) % 3, axis_2 = (plate.normal + 2) % 3;
  Mesh mesh;
  for (int k = 0; k <= through; ++k) {
    for (int j = 0; j <= along_2; ++j) {
      for (int i = 0; i <= along_1; ++i) {
        Vec3 node = plate.centre;
        node[axis_1] += plate.size[0] * (static_cast<double>(i) / along_1 - 0.5);
        node[axis_2] += plate.size[1] * (static_cast<double>(j) / along_2 - 0.5);
        node[plate.normal] += plate.thickness * (static_cast<double>(k) / through - 0.5);
        mesh.nodes.push_back(node);
      }
    }
  }
  const int row = along_1 + 1, layer = row * (along_2 + 1);
  for (int k = 0; k < through; ++k) {
    for (int j = 0; j < along_2; ++j) {
      for (int i = 0; i < along_1; ++i) {
        const int n = i + row * j + layer * k;
        mesh.hexahedra.push_back({n, n + 1, n + 1 + row, n + row,  //
                                  n + layer, n + 1 + layer, n + 1 + row + layer, n + row + layer});
      }
    }
  }
  return mesh;
}

Mesh make_sheet(const SheetDescription& sheet) {
  const auto& [along_1, along_2] = sheet.elements;
  expect_elements("sheet", {along_1, along_2});
  const auto& c = sheet.corner;
  Mesh mesh;
  for (int j = 0; j <= along_2; ++j) {
    for (int i = 0; i <= along_1; ++i) {
      const double xi = static_cast<double>(i) / along_1, eta = static_cast<double>(j) / along_2;
      mesh.nodes.emplace_back((1.0 - eta) * ((1.0 - xi) * c[0] + xi * c[1]) + eta * ((1.0 - xi) * c[3] + xi * c[2]));
    }
  }
  const int row = along_1 + 1;
  for (int j = 0; j < along_2; ++j) {
    for (int i = 0; i < along_1; ++i) {
      const int n = i + row * j;
      mesh.quadrilaterals.push_back({n, n + 1, n + 1 + row, n + row});
    }
  }
  if (sheet.triangles) halve(mesh);
  return mesh;
}

Mesh make_disk(const DiskDescription& disk) {
  const auto& [across, layers] = disk.elements;
  expect_axis("disk", disk.normal);
  expect_elements("disk", {across, layers});
  if (!(disk.radius > 0.0)) {
    throw InputError(fmt::format("the disk's radius is {} m; expected a positive length", disk.radius));
  }
  constexpr double half_side = 0.4;  // of the inner square, over the radius
  const Vec3 e1 = Vec3::Unit((disk.normal + 1) % 3), e2 = Vec3::Unit((disk.normal + 2) % 3);
  const auto place = [&](double a, double b) { return Vec3(disk.centre + disk.radius * (a * e1 + b * e2)); };
  const double half = half_side * disk.radius;
  Mesh mesh = make_sheet({{Vec3(disk.centre - half * e1 - half * e2), Vec3(disk.centre + half * e1 - half * e2),
                           Vec3(disk.centre + half * e1 + half * e2), Vec3(disk.centre - half * e1 + half * e2)},
                          {across, across}});
  const int row = across + 1, around = 4 * across;
  std::vector<int> ring;  // around the inner square, then around each layer
  for (int k = 0; k < across; ++k) ring.push_back(k);
  for (int k = 0; k < across; ++k) ring.push_back(across + k * row);
  for (int k = 0; k < across; ++k) ring.push_back(row * row - 1 - k);
  for (int k = 0; k < across; ++k) ring.push_back(across * row - k * row);
  const std::vector<int> inner = ring;
  for (int layer = 1; layer <= layers; ++layer) {
    const double share = static_cast<double>(layer) / layers;
    std::vector<int> next;
    for (int k = 0; k < around; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / around - 0.75 * std::numbers::pi;
      next.push_back(static_cast<int>(mesh.nodes.size()));
      mesh.nodes.emplace_back((1.0 - share) * mesh.nodes[inner[k]] + share * place(std::cos(angle), std::sin(angle)));
    }
    for (int k = 0; k < around; ++k) {
      const int after = (k + 1) % around;
      mesh.quadrilaterals.push_back({ring[k], next[k], next[after], ring[after]});
    }
    ring = next;
  }
  if (disk.triangles) halve(mesh);
  mesh.node_sets["rim"] = ring;
  mesh.node_sets["centre"] = {node_nearest(mesh, disk.centre)};
  return mesh;
}

Mesh extruded(const Mesh& sheet, const Vec3& way, int layers) {
  expect_elements("extruded sheet", {layers});
  Mesh mesh;
  for (int k = 0; k <= layers; ++k) {
    for (const Vec3& node : sheet.nodes) mesh.nodes.emplace_back(node + static_cast<double>(k) / layers * way);
  }
  const int layer = static_cast<int>(sheet.nodes.size());
  for (int k = 0; k < layers; ++k) {
    for (const auto& face : sheet.quadrilaterals) {
      std::array<int, 8> element;
      for (int a = 0; a < 8; ++a) element[a] = face[a % 4] + (k + a / 4) * layer;
      mesh.hexahedra.push_back(element);
    }
  }
  return mesh;
}

int add_point(Mesh& mesh, const std::string& name, const Vec3& place) {
  const int node = static_cast<int>(mesh.nodes.size());
  mesh.nodes.push_back(place);
  mesh.node_sets[name].push_back(node);
  return node;
}

void add_line(Mesh& mesh, const std::string& name, int from, int to, int elements) {
  expect_elements("line", {elements});
  const Vec3 start = mesh.nodes[from], way = mesh.nodes[to] - start;
  std::vector<int>& set = mesh.node_sets[name];
  int before = from;
  set.push_back(from);
  for (int k = 1; k <= elements; ++k) {
    const int next = k == elements ? to : static_cast<int>(mesh.nodes.size());
    if (k < elements) mesh.nodes.emplace_back(start + static_cast<double>(k) / elements * way);
    mesh.element_sets[name].lines.push_back(static_cast<int>(mesh.lines.size()));
    mesh.lines.push_back({before, next});
    set.push_back(next);
    before = next;
  }
}

}  // namespace drogue::fem
