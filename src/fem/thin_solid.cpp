// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/thin_solid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <tuple>

#include "fem/hex_topology.hpp"

namespace drogue::fem {
namespace {

using Face = std::array<int, 4>;

/// Nodes of the first (`side` 0) or last face of an element along a direction, in order around it.
Face face_of(const std::array<int, 8>& element, int direction, int side) {
  constexpr int around[4] = {0, 1, 3, 2};
  Face face;
  for (int k = 0; k < 4; ++k) face[k] = element[hex_edge[direction][around[k]][side]];
  return face;
}

Face sorted(Face face) {
  std::sort(face.begin(), face.end());
  return face;
}

/// Faces that belong to one element only, as sorted node numbers, in order.
std::vector<Face> boundary_faces(const Mesh& mesh) {
  std::vector<Face> all;
  all.reserve(6 * mesh.hexahedra.size());
  for (const auto& element : mesh.hexahedra) {
    for (int direction = 0; direction < 3; ++direction) {
      for (int side = 0; side < 2; ++side) all.push_back(sorted(face_of(element, direction, side)));
    }
  }
  std::sort(all.begin(), all.end());
  std::vector<Face> boundary;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t next = i + 1;
    while (next < all.size() && all[next] == all[i]) ++next;
    if (next == i + 1) boundary.push_back(all[i]);
    i = next;
  }
  return boundary;
}

double mean_edge_length(const Mesh& mesh, const std::array<int, 8>& element, int direction) {
  double sum = 0.0;
  for (const auto& [first, last] : hex_edge[direction])
    sum += (mesh.nodes[element[last]] - mesh.nodes[element[first]]).norm();
  return sum / 4.0;
}

/// The direction in which an element spans the solid: both its faces are free; if that holds of several, the shortest.
std::optional<int> thickness_direction(const Mesh& mesh, const std::array<int, 8>& element,
                                       const std::vector<Face>& boundary) {
  const auto is_free = [&](int direction, int side) {
    return std::binary_search(boundary.begin(), boundary.end(), sorted(face_of(element, direction, side)));
  };
  std::optional<int> best;
  double shortest = std::numeric_limits<double>::infinity();
  for (int direction = 0; direction < 3; ++direction) {
    const double length = mean_edge_length(mesh, element, direction);
    if (length < shortest && is_free(direction, 0) && is_free(direction, 1)) {
      best = direction;
      shortest = length;
    }
  }
  return best;
}

/// Adds to each node of a bilinear face its share of the area, by 2x2 Gauss points.
void lump_area(const Mesh& mesh, const Face& face, std::vector<double>& area) {
  constexpr int sign[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (const auto& [qx, qy] : sign) {
    const double xi = gauss_abscissa * qx, eta = gauss_abscissa * qy;
    Vec3 along_xi = Vec3::Zero(), along_eta = Vec3::Zero();
    for (int a = 0; a < 4; ++a) {
      along_xi += 0.25 * sign[a][0] * (1.0 + sign[a][1] * eta) * mesh.nodes[face[a]];
      along_eta += 0.25 * sign[a][1] * (1.0 + sign[a][0] * xi) * mesh.nodes[face[a]];
    }
    const double weight = along_xi.cross(along_eta).norm();
    for (int a = 0; a < 4; ++a) area[face[a]] += 0.25 * (1.0 + sign[a][0] * xi) * (1.0 + sign[a][1] * eta) * weight;
  }
}

}  // namespace

std::vector<std::array<int, 2>> thickness_pairs(const Mesh& mesh, double max_thickness) {
  const std::vector<Face> boundary = boundary_faces(mesh);
  struct Candidate {
    double length;
    std::array<int, 2> pair;
    bool operator<(const Candidate& other) const { return std::tie(length, pair) < std::tie(other.length, other.pair); }
  };
  std::set<Candidate> candidates;
  for (const auto& element : mesh.hexahedra) {
    const auto direction = thickness_direction(mesh, element, boundary);
    if (!direction) continue;
    for (const auto& [first, last] : hex_edge[*direction]) {
      const auto [a, b] = std::minmax(element[first], element[last]);
      const double length = (mesh.nodes[a] - mesh.nodes[b]).norm();
      if (length <= max_thickness * (1.0 + 1e-9)) candidates.insert({length, {a, b}});
    }
  }
  // Where a folded solid offers a node two partners, the nearer one wins.
  std::vector<bool> taken(mesh.nodes.size(), false);
  std::vector<std::array<int, 2>> pairs;
  for (const auto& [length, pair] : candidates) {
    if (taken[pair[0]] || taken[pair[1]]) continue;
    taken[pair[0]] = taken[pair[1]] = true;
    pairs.push_back(pair);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<std::array<int, 4>> outer_faces(const Mesh& mesh) {
  const std::vector<Face> boundary = boundary_faces(mesh);
  std::vector<Face> outer;
  for (const auto& element : mesh.hexahedra) {
    for (int direction = 0; direction < 3; ++direction) {
      for (int side = 0; side < 2; ++side) {
        const Face face = face_of(element, direction, side);
        if (std::binary_search(boundary.begin(), boundary.end(), sorted(face))) outer.push_back(face);
      }
    }
  }
  return outer;
}

std::vector<Vec3> area_normals(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.nodes.size(), Vec3::Zero());
  const auto add = [&](const auto& element) {
    for (std::size_t a = 0; a < element.size(); ++a) {
      const Vec3& corner = mesh.nodes[element[a]];
      const Vec3 next = mesh.nodes[element[(a + 1) % element.size()]] - corner;
      const Vec3 last = mesh.nodes[element[(a + element.size() - 1) % element.size()]] - corner;
      normals[element[a]] += 0.5 * next.cross(last);
    }
  };
  std::ranges::for_each(mesh.quadrilaterals, add);
  std::ranges::for_each(mesh.triangles, add);
  return normals;
}

std::vector<double> pair_areas(const Mesh& mesh, const std::vector<std::array<int, 2>>& pairs) {
  std::vector<int> partner(mesh.nodes.size(), -1);
  for (const auto& [a, b] : pairs) {
    partner[a] = b;
    partner[b] = a;
  }
  std::vector<double> area(mesh.nodes.size(), 0.0);
  for (const auto& element : mesh.hexahedra) {
    for (int direction = 0; direction < 3; ++direction) {
      const bool spans = std::any_of(std::begin(hex_edge[direction]), std::end(hex_edge[direction]),
                                     [&](const auto& e) { return partner[element[e[0]]] == element[e[1]]; });
      if (!spans) continue;
      for (int side = 0; side < 2; ++side) lump_area(mesh, face_of(element, direction, side), area);
    }
  }
  std::vector<double> areas;
  for (const auto& [a, b] : pairs) areas.push_back(0.5 * (area[a] + area[b]));
  return areas;
}

}  // namespace drogue::fem
