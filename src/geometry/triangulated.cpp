// SPDX-License-Identifier: GPL-3.0-or-later
// Points on a triangulated surface, however coarse or fine its triangles: they are cut into pieces much smaller than
// the spacing; a piece becomes a point if there is none near it yet, and otherwise counts for the nearest. Pieces that
// look the other way belong to the other side of a thin body and do not count as near.
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "geometry/surface.hpp"

namespace drogue::geometry {

namespace {

constexpr double nearest_points = 0.85;       // of the spacing: about one point per square of it remains
constexpr double largest_piece = 1.0 / 16.0;  // of the square of the spacing

struct Piece {
  Vec3 centre, normal;
  double area;
};

/// Halves a triangle across its longest edge until it is small enough.
void cut(const Vec3& a, const Vec3& b, const Vec3& c, double largest, std::vector<Piece>& pieces) {
  const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  if (ab < bc || ab < ca) return bc >= ca ? cut(b, c, a, largest, pieces) : cut(c, a, b, largest, pieces);
  if (ab > 4.0 * largest) {  // a piece with a right angle and this longest edge has the largest area
    const Vec3 middle = 0.5 * (a + b);
    cut(a, middle, c, largest, pieces);
    cut(middle, b, c, largest, pieces);
    return;
  }
  const Vec3 cross = (b - a).cross(c - a);
  const double area = 0.5 * cross.norm();
  if (area > 0.0) pieces.push_back({(a + b + c) / 3.0, cross.normalized(), area});
}

/// The points found so far, by cubes as large as the distance within which one is looked for.
class Neighbours {
 public:
  explicit Neighbours(double reach) : reach_(reach) {}

  void add(int index, const Vec3& place) { cubes_[key(cube(place))].push_back(index); }

  /// The nearest point on the same side within reach, or -1.
  int nearest(const Piece& piece, const Surface& surface) const {
    const Index3 home = cube(piece.centre);
    int best = -1;
    double smallest = reach_ * reach_;
    for (int offset = 0; offset < 27; ++offset) {
      const auto found =
          cubes_.find(key({home[0] + offset % 3 - 1, home[1] + offset / 3 % 3 - 1, home[2] + offset / 9 - 1}));
      if (found == cubes_.end()) continue;
      for (const int i : found->second) {
        const double distance = (surface.point[i] - piece.centre).squaredNorm();
        if (distance >= smallest || surface.normal[i].dot(piece.normal) <= 0.0) continue;
        smallest = distance;
        best = i;
      }
    }
    return best;
  }

 private:
  Index3 cube(const Vec3& place) const {
    Index3 index;
    for (int a = 0; a < 3; ++a) index[a] = static_cast<int>(std::floor(place[a] / reach_));
    return index;
  }
  static std::uint64_t key(const Index3& cube) {
    std::uint64_t key = 0;
    for (const int i : cube) key = key << 21 | (static_cast<std::uint64_t>(i) & 0x1fffff);
    return key;
  }

  double reach_;
  std::unordered_map<std::uint64_t, std::vector<int>> cubes_;
};

}  // namespace

Surface sample(const TriangleMesh& mesh, double spacing) {
  std::vector<Piece> pieces;
  for (const auto& [a, b, c] : mesh.triangles) {
    cut(mesh.points[a], mesh.points[b], mesh.points[c], largest_piece * spacing * spacing, pieces);
  }
  Surface surface;
  Neighbours neighbours(nearest_points * spacing);
  for (const Piece& piece : pieces) {
    if (neighbours.nearest(piece, surface) >= 0) continue;
    neighbours.add(static_cast<int>(surface.point.size()), piece.centre);
    surface.point.push_back(piece.centre);
    surface.normal.push_back(piece.normal);
  }
  surface.area.assign(surface.point.size(), 0.0);
  for (const Piece& piece : pieces) surface.area[neighbours.nearest(piece, surface)] += piece.area;
  surface.enclosed = solid_of(mesh);
  surface.picture = mesh;
  return surface;
}

Shape triangulated(const std::filesystem::path& file) {
  const TriangleMesh mesh = read_triangles(file);
  return {.centre = solid_of(mesh).centre, .encloses_volume = is_closed(mesh), .sample = [mesh](double spacing) {
            return sample(mesh, spacing);
          }};
}

}  // namespace drogue::geometry
