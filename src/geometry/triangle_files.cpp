// SPDX-License-Identifier: GPL-3.0-or-later
// STL is a list of facets without neighbours: in words ("facet normal ... vertex x y z ..."), or in bytes, 80 of title,
// a count, and 50 for each facet. A file in bytes may begin with the word "solid" as well, so its length decides.
#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "geometry/msh_file.hpp"
#include "geometry/triangle_mesh.hpp"

namespace drogue::geometry {

namespace {

/// Builds a mesh from triangles given by their corners; equal corners become one point.
class Builder {
 public:
  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const std::array<int, 3> triangle{number(a), number(b), number(c)};
    const bool is_line = triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
    if (!is_line) mesh_.triangles.push_back(triangle);
  }
  TriangleMesh take() { return std::move(mesh_); }

 private:
  int number(const Vec3& p) {
    const auto [place, is_new] = numbers_.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(mesh_.points.size()));
    if (is_new) mesh_.points.push_back(p);
    return place->second;
  }

  TriangleMesh mesh_;
  std::map<std::array<double, 3>, int> numbers_;
};

constexpr std::size_t header_bytes = 84, facet_bytes = 50;

bool is_binary(const std::string& text) {
  if (text.size() < header_bytes) return false;
  std::uint32_t facets;
  std::memcpy(&facets, text.data() + header_bytes - sizeof facets, sizeof facets);
  return text.size() == header_bytes + facets * facet_bytes;
}

TriangleMesh read_binary_stl(const std::string& text) {
  Builder builder;
  for (std::size_t at = header_bytes; at < text.size(); at += facet_bytes) {
    std::array<float, 12> v;  // normal, then three corners
    std::memcpy(v.data(), text.data() + at, sizeof v);
    builder.add(Vec3(v[3], v[4], v[5]), Vec3(v[6], v[7], v[8]), Vec3(v[9], v[10], v[11]));
  }
  return builder.take();
}

double parse_number(std::string_view word, const std::string& place) {
  double value = 0.0;
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) {
    throw InputError(fmt::format("{}: expected a coordinate, found '{}'", place, word));
  }
  return value;
}

TriangleMesh read_text_stl(std::ifstream& stream, const std::string& file) {
  Builder builder;
  std::vector<Vec3> corners;
  std::string line, word;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::string place = fmt::format("{}:{}", file, number);
    std::istringstream words(line);
    words >> word;
    if (number == 1 && word != "solid") throw InputError(fmt::format("{}: expected the word solid of an STL", place));
    if (word == "vertex") {
      Vec3& corner = corners.emplace_back();
      for (int a = 0; a < 3; ++a) {
        word.clear();
        words >> word;
        corner[a] = parse_number(word, place);
      }
    } else if (word == "endfacet") {
      if (corners.size() != 3) {
        throw InputError(fmt::format("{}: a facet of {} vertices; expected 3", place, corners.size()));
      }
      builder.add(corners[0], corners[1], corners[2]);
      corners.clear();
    }
    word.clear();
  }
  if (!corners.empty()) throw InputError(fmt::format("{}: the file ends within a facet", file));
  return builder.take();
}

TriangleMesh read_stl(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(fmt::format("{}: cannot be opened; expected an STL file", file.string()));
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  if (is_binary(text)) return read_binary_stl(text);
  stream.clear();
  stream.seekg(0);
  return read_text_stl(stream, file.string());
}

TriangleMesh read_msh_triangles(const std::filesystem::path& file) {
  const MshContent content = read_msh_content(file);
  Builder builder;
  for (const MshBlock& block : content.blocks) {
    const std::size_t corners = block.type == msh_triangle ? 3 : block.type == msh_quadrangle ? 4 : 0;
    for (std::size_t i = 0; corners > 0 && i < block.tags.size(); i += corners) {
      const auto corner = [&](std::size_t c) { return content.position_of(block.tags[i + c], block); };
      builder.add(corner(0), corner(1), corner(2));
      if (corners == 4) builder.add(corner(0), corner(2), corner(3));
    }
  }
  return builder.take();
}

}  // namespace

TriangleMesh read_triangles(const std::filesystem::path& file) {
  TriangleMesh mesh = file.extension() == ".msh" ? read_msh_triangles(file) : read_stl(file);
  if (mesh.triangles.empty()) throw InputError(fmt::format("{}: no triangles", file.string()));
  bool closed = false;
  try {
    closed = is_closed(mesh);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
  if (closed && solid_of(mesh).volume < 0.0) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

}  // namespace drogue::geometry
