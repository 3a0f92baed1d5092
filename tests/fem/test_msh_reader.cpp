// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>

#include "bodies.hpp"
#include "core/error.hpp"

namespace drogue::fem {
namespace {

/// Writes numbers as gmsh does, in words or in bytes.
class Writer {
 public:
  explicit Writer(bool binary) : binary_(binary) {}

  Writer& text(const std::string& words) {
    content_ += words;
    return *this;
  }
  template <class T>
  Writer& put(T value) {
    if (binary_) {
      content_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    } else {
      std::ostringstream out;
      out.precision(17);
      out << value << '\n';
      content_ += out.str();
    }
    return *this;
  }
  Writer& integers(const std::vector<int>& values) {
    for (const int value : values) put(value);
    return *this;
  }
  Writer& counts(const std::vector<std::uint64_t>& values) {
    for (const std::uint64_t value : values) put(value);
    return *this;
  }
  bool binary() const { return binary_; }
  const std::string& content() const { return content_; }

 private:
  bool binary_;
  std::string content_;
};

/// A block of 2 x 1 x 1 hexahedra, its face x = 0 as a quadrangle and one of its corners as a point; node tags start
/// at 101 and the first node belongs to no hexahedron.
std::string two_hexahedra(bool binary) {
  const Mesh mesh = block({2.0, 1.0, 1.0}, {2, 1, 1});
  const std::uint64_t nodes = mesh.nodes.size();
  Writer w(binary);
  w.text(binary ? "$MeshFormat\n4.1 1 8\n" : "$MeshFormat\n4.1 0 8\n");
  if (binary) w.put(1);
  w.text("\n$EndMeshFormat\n$PhysicalNames\n3\n0 7 \"tip\"\n2 3 \"left face\"\n3 9 \"cloth\"\n$EndPhysicalNames\n");
  w.text("$Comments\nwhatever $Nodes says\n$EndComments\n");

  w.text("$Entities\n").counts({1, 0, 1, 1});
  w.put(1).put(0.0).put(0.0).put(0.0).counts({1}).put(7);
  w.put(4);
  for (int k = 0; k < 6; ++k) w.put(0.25 * k);
  w.counts({1}).put(-3).counts({2}).integers({11, -12});
  w.put(5);
  for (int k = 0; k < 6; ++k) w.put(0.5 * k);
  w.counts({2}).integers({9, 10}).counts({0});
  w.text("\n$EndEntities\n");

  w.text("$Nodes\n").counts({2, nodes + 1, 100, 100 + nodes});
  w.integers({2, 4, 1}).counts({1, 100}).put(-9.0).put(-9.0).put(-9.0).put(0.5).put(0.5);
  w.integers({3, 5, 0}).counts({nodes});
  for (std::uint64_t i = 0; i < nodes; ++i) w.put(101 + i);
  for (const Vec3& p : mesh.nodes) w.put(p.x()).put(p.y()).put(p.z());
  w.text("\n$EndNodes\n");

  w.text("$Elements\n").counts({3, 4, 1, 4});
  w.integers({0, 1, 15}).counts({1, 1, 101});
  w.integers({2, 4, 3}).counts({1, 2, 101, 104, 110, 107});
  w.integers({3, 5, 5}).counts({2});
  for (std::uint64_t e = 0; e < 2; ++e) {
    w.put(3 + e);
    for (const int node : mesh.hexahedra[e]) w.put(std::uint64_t(101 + node));
  }
  w.text("\n$EndElements\n");
  return w.content();
}

std::filesystem::path write(const std::string& content) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const auto file = std::filesystem::path(testing::TempDir()) / (std::string("drogue_") + test->name() + ".msh");
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

std::string complaint(const std::string& content) {
  const auto file = write(content);
  try {
    read_msh(file);
  } catch (const InputError& error) {
    const std::string text = error.what(), name = file.string();
    EXPECT_EQ(text.substr(0, name.size()), name);
    return text.substr(name.size());
  }
  return "";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

void expect_two_hexahedra(const Mesh& mesh) {
  const Mesh expected = block({2.0, 1.0, 1.0}, {2, 1, 1});
  ASSERT_EQ(mesh.nodes.size(), 12u);
  ASSERT_EQ(mesh.hexahedra.size(), 2u);
  for (int e = 0; e < 2; ++e) {
    for (int a = 0; a < 8; ++a) EXPECT_EQ(mesh.nodes[mesh.hexahedra[e][a]], expected.nodes[expected.hexahedra[e][a]]);
  }
  ASSERT_EQ(mesh.node_sets.size(), 4u);
  EXPECT_EQ(mesh.node_sets.at("cloth").size(), 12u);
  EXPECT_EQ(mesh.node_sets.at("10").size(), 12u);
  EXPECT_EQ(mesh.node_sets.at("left face").size(), 4u);
  for (const int node : mesh.node_sets.at("left face")) EXPECT_EQ(mesh.nodes[node].x(), -1.0);
  ASSERT_EQ(mesh.node_sets.at("tip").size(), 1u);
  EXPECT_EQ(mesh.nodes[mesh.node_sets.at("tip")[0]], Vec3(-1.0, -0.5, -0.5));
  ASSERT_EQ(mesh.element_sets.size(), 3u);
  ASSERT_EQ(mesh.quadrilaterals.size(), 1u);
  EXPECT_EQ(mesh.element_sets.at("cloth").hexahedra, (std::vector{0, 1}));
  EXPECT_EQ(mesh.element_sets.at("left face").quadrilaterals, std::vector{0});
}

TEST(MshReader, ascii_file_gives_nodes_elements_and_sets) {
  expect_two_hexahedra(read_msh(write(two_hexahedra(false))));
}

TEST(MshReader, binary_file_gives_the_same) { expect_two_hexahedra(read_msh(write(two_hexahedra(true)))); }

TEST(MshReader, mistakes_in_a_file_are_named_with_their_line) {
  const std::string good = two_hexahedra(false);
  EXPECT_EQ(complaint("hello"), ":1: expected $MeshFormat at the start of a gmsh mesh file");
  EXPECT_EQ(complaint(replaced(good, "4.1 0 8", "2.2 0 8")), ":2: mesh format 2.2; expected 4.1 (gmsh -format msh41)");
  EXPECT_EQ(complaint(replaced(good, "4.1 0 8", "4.1 0 4")), ":2: counts of 4 bytes; expected 8");
  EXPECT_EQ(complaint(replaced(good, "0 7 \"tip\"", "0 x7 \"tip\"")), ":7: expected a number, found 'x7'");
  EXPECT_EQ(complaint(replaced(good, "\"tip\"", "tip")), ":8: expected a name in quotation marks");
  EXPECT_NE(complaint(good.substr(0, good.size() / 2)).find("the file ends too early"), std::string::npos);
  EXPECT_NE(complaint(good.substr(0, good.find("$EndElements"))).find("expected $EndElements"), std::string::npos);
  EXPECT_NE(complaint(replaced(good, "$Entities", "Entities")).find("expected the start of a section"),
            std::string::npos);
}

TEST(MshReader, a_damaged_binary_file_is_refused) {
  const std::string good = two_hexahedra(true);
  EXPECT_NE(complaint(good.substr(0, good.size() - 150)).find("the file ends too early"), std::string::npos);
  std::string swapped = good;
  std::reverse(swapped.begin() + 20, swapped.begin() + 24);
  EXPECT_NE(complaint(swapped).find("the other byte order"), std::string::npos);
  std::string huge = good;
  huge[huge.find("$Nodes\n") + 7 + 5] = 1;
  EXPECT_NE(complaint(huge).find("exceeds the length of the file"), std::string::npos);
}

TEST(MshReader, elements_it_cannot_use_are_refused) {
  const std::string good = two_hexahedra(false);
  const std::string volume = "\n3\n5\n5\n2\n";
  EXPECT_NE(complaint(replaced(good, volume, "\n3\n5\n4\n2\n")).find("volume 5 has elements of type 4"),
            std::string::npos);
  EXPECT_NE(complaint(replaced(good, volume, "\n3\n5\n99\n2\n")).find("elements of type 99"), std::string::npos);
  EXPECT_NE(complaint(replaced(good, "\n112\n1", "\n113\n1")).find("uses node 113, which the file does not define"),
            std::string::npos);
  const std::size_t elements = good.find("$Elements");
  EXPECT_EQ(complaint(good.substr(0, elements)), ": no elements; expected hexahedra, quadrangles, triangles or lines");
}

TEST(MshReader, a_missing_file_is_named) {
  try {
    read_msh("no/such/mesh.msh");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "no/such/mesh.msh: cannot be opened; expected a gmsh mesh file");
  }
}

}  // namespace
}  // namespace drogue::fem
