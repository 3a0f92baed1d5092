// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <fstream>
#include <numeric>

#include "core/error.hpp"
#include "geometry/surface.hpp"

namespace drogue::geometry {
namespace {

/// Axis-aligned box with two triangles a face; `inwards` turns them all.
TriangleMesh box(const Vec3& lower, const Vec3& upper, bool inwards = false) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.points.emplace_back(i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(),
                             i & 4 ? upper.z() : lower.z());
  }
  for (const auto& [a, b, c, d] : std::vector<std::array<int, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    mesh.triangles.push_back(inwards ? std::array{a, c, b} : std::array{a, b, c});
    mesh.triangles.push_back(inwards ? std::array{a, d, c} : std::array{a, c, d});
  }
  return mesh;
}

std::string ascii_stl(const TriangleMesh& mesh) {
  std::ostringstream out;
  out << "solid a box\n";
  for (const auto& triangle : mesh.triangles) {
    out << "  facet normal 0 0 0\n    outer loop\n";
    for (int i : triangle) out << "      vertex " << mesh.points[i].transpose() << "\n";
    out << "    endloop\n  endfacet\n";
  }
  out << "endsolid\n";
  return out.str();
}

std::string binary_stl(const TriangleMesh& mesh) {
  std::string bytes = "solid, though binary";
  bytes.resize(80, ' ');
  const auto put = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) put(0.0f);
    for (int i : triangle) {
      for (int a = 0; a < 3; ++a) put(static_cast<float>(mesh.points[i][a]));
    }
    put(std::uint16_t{0});
  }
  return bytes;
}

/// Two triangles and a quadrangle: an open unit square strip along x, with gmsh's node tags 1 to 6 and a point.
const char* msh = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Nodes
1 6 1 6
2 1 0 6
1
2
3
4
5
6
0 0 0
1 0 0
2 0 0
0 1 0
1 1 0
2 1 0
$EndNodes
$Elements
3 4 1 4
0 1 15 1
1 1
2 1 2 2
2 1 2 5
3 1 5 4
2 1 3 1
4 2 3 6 5
$EndElements
)";

class Files : public testing::Test {
 protected:
  ~Files() override { std::filesystem::remove(file_); }
  TriangleMesh read(const std::string& content, const std::string& suffix) {
    file_ = std::filesystem::path(testing::TempDir()) / ("drogue_surface_" + std::to_string(getpid()) + suffix);
    std::ofstream(file_, std::ios::binary) << content;
    return read_triangles(file_);
  }
  std::string complaint(const std::string& content, const std::string& suffix) {
    try {
      read(content, suffix);
    } catch (const InputError& error) {
      const std::string text = error.what(), name = file_.string();
      EXPECT_TRUE(text.starts_with(name)) << text;
      return text.substr(std::min(text.size(), name.size()));
    }
    return "no error";
  }
  std::filesystem::path file_;
};

TEST_F(Files, stl_in_words_and_bytes_give_the_same_closed_surface) {
  const TriangleMesh cube = box({-0.5, 0.0, 0.25}, {0.5, 2.0, 1.25});
  for (const TriangleMesh& mesh : {read(ascii_stl(cube), ".stl"), read(binary_stl(cube), ".stl")}) {
    EXPECT_EQ(mesh.points.size(), 8u) << "corners that coincide are one";
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_NEAR(solid_of(mesh).volume, 2.0, 1e-12);
  }
}

TEST_F(Files, a_surface_that_looks_inwards_is_turned) {
  EXPECT_NEAR(solid_of(read(ascii_stl(box({0, 0, 0}, {1, 1, 1}, true)), ".stl")).volume, 1.0, 1e-12);
}

TEST_F(Files, msh_gives_its_triangles_and_quadrangles) {
  const TriangleMesh mesh = read(msh, ".msh");
  EXPECT_EQ(mesh.points.size(), 6u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_FALSE(is_closed(mesh));
  EXPECT_EQ(solid_of(mesh).volume, 0.0);
  EXPECT_LT((solid_of(mesh).centre - Vec3(1.0, 0.5, 0.0)).norm(), 1e-12);
}

TEST_F(Files, mistakes_are_named_with_their_line) {
  EXPECT_EQ(complaint("hello\n", ".stl"), ":1: expected the word solid of an STL");
  EXPECT_EQ(complaint("solid\nfacet\nvertex 1 2 x\n", ".stl"), ":3: expected a coordinate, found 'x'");
  EXPECT_EQ(complaint("solid\nvertex 1 2\n", ".stl"), ":2: expected a coordinate, found ''");
  EXPECT_EQ(complaint("solid\nvertex 1 2 3\nendfacet\n", ".stl"), ":3: a facet of 1 vertices; expected 3");
  EXPECT_EQ(complaint("solid\nvertex 1 2 3\n", ".stl"), ": the file ends within a facet");
  EXPECT_EQ(complaint("solid\nendsolid\n", ".stl"), ": no triangles");
  TriangleMesh twisted = box({0, 0, 0}, {1, 1, 1});
  std::swap(twisted.triangles[3][0], twisted.triangles[3][1]);
  EXPECT_NE(complaint(ascii_stl(twisted), ".stl").find("two triangles of opposite orientation"), std::string::npos);
}

TEST(Solid, of_a_box_is_exact_wherever_it_stands) {
  const Vec3 size(1.0, 2.0, 3.0), centre(5.0, -4.0, 3.0);
  const Solid solid = solid_of(box(centre - 0.5 * size, centre + 0.5 * size));
  EXPECT_NEAR(solid.volume, 6.0, 1e-12);
  EXPECT_LT((solid.centre - centre).norm(), 1e-12);
  const Vec3 inertia = 6.0 / 12.0 * Vec3(4.0 + 9.0, 1.0 + 9.0, 1.0 + 4.0);
  EXPECT_LT((solid.inertia - Mat3(inertia.asDiagonal())).norm(), 1e-9);
}

/// A sphere of radius 1 whose triangles have edges of about pi / n.
TriangleMesh ball(int n) { return sphere(Vec3::Zero(), 2.0).sample(3.141592653589793 / n).picture; }

TEST(Sampling, areas_add_up_and_points_keep_their_distance_whatever_the_triangles) {
  for (const TriangleMesh& mesh : {box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 0.01, 1}), ball(60)}) {
    double area = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
      area += 0.5 * (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]).norm();
    }
    const Surface surface = sample(mesh, 0.1);
    EXPECT_NEAR(std::accumulate(surface.area.begin(), surface.area.end(), 0.0), area, 1e-9 * area);
    EXPECT_GT(static_cast<double>(surface.point.size()), 0.7 * area / 0.01);
    EXPECT_LT(static_cast<double>(surface.point.size()), 1.6 * area / 0.01);
    for (std::size_t i = 0; i < surface.point.size(); ++i) {
      EXPECT_GT(surface.area[i], 0.0);
      for (std::size_t j = 0; j < i; ++j) {
        if (surface.normal[i].dot(surface.normal[j]) <= 0.0) continue;
        ASSERT_GE((surface.point[i] - surface.point[j]).norm(), 0.085 * (1 - 1e-12));
      }
    }
  }
}

}  // namespace
}  // namespace drogue::geometry
