// SPDX-License-Identifier: GPL-3.0-or-later
// Reads gmsh's MSH 4.1 format (gmsh reference manual, "MSH file format"), ASCII or binary with 8-byte counts. A section
// is read by the same code in both: a sequence of numbers of known types. gmsh numbers the nodes of a hexahedron as VTK
// does.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>
#include <unordered_map>

#include "core/error.hpp"
#include "fem/hex_mesh.hpp"

namespace drogue::fem {
namespace {

using Count = std::uint64_t;

/// The text of a file, read from front to back; every complaint names the file and, up to the first binary number, the
/// line.
class Source {
 public:
  explicit Source(const std::filesystem::path& file) : name_(file.string()) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(fmt::format("{}: cannot be opened; expected a gmsh mesh file", name_));
    text_.assign(std::istreambuf_iterator<char>(stream), {});
  }

  [[noreturn]] void complain(const std::string& what) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    throw InputError(binary_ ? fmt::format("{}: byte {}: {}", name_, at_, what)
                             : fmt::format("{}:{}: {}", name_, line, what));
  }

  void become_binary() { binary_ = true; }
  bool binary() const { return binary_; }

  bool skip_space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return at_ < text_.size();
  }

  /// The next word, in both kinds of file.
  std::string_view word() {
    if (!skip_space()) complain("the file ends too early");
    const std::size_t begin = at_;
    while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return std::string_view(text_).substr(begin, at_ - begin);
  }

  /// The rest of the line, without its end.
  std::string_view line() {
    const std::size_t begin = at_, end = std::min(text_.find('\n', begin), text_.size());
    at_ = std::min(end + 1, text_.size());
    return std::string_view(text_).substr(begin, end - begin);
  }

  template <class T>
  T number_in_words() {
    const std::string_view token = word();
    T value{};
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (error != std::errc() || end != token.data() + token.size())
      complain(fmt::format("expected a number, found '{}'", token));
    return value;
  }

  template <class T>
  T number() {
    if (!binary_) return number_in_words<T>();
    if (text_.size() - at_ < sizeof(T)) complain("the file ends too early");
    T value;
    std::memcpy(&value, text_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  /// A count of things that take at least a byte each, so that a damaged file cannot ask for more memory than it has.
  Count count() {
    const Count n = number<Count>();
    if (n > text_.size()) complain(fmt::format("a count of {} exceeds the length of the file", n));
    return n;
  }

  void skip_past(std::string_view mark) {
    const std::size_t found = text_.find(mark, at_);
    if (found == std::string::npos) complain(fmt::format("expected {} later in the file", mark));
    at_ = found + mark.size();
  }

 private:
  std::string name_, text_;
  std::size_t at_ = 0;
  bool binary_ = false;
};

struct Block {
  int dimension, entity, type;
  std::vector<Count> tags;  ///< node tags of its elements, one element after the other
};

struct Content {
  std::map<std::array<int, 2>, std::string> group_name;   ///< of {dimension, group}
  std::map<std::array<int, 2>, std::vector<int>> groups;  ///< of {dimension, entity}
  std::unordered_map<Count, Vec3> position;               ///< by node tag
  std::vector<Block> blocks;
};

constexpr int hexahedron = 5;

/// Nodes of an element of gmsh type 1, 2, ..., 31; 0 where the manual lists none.
constexpr int nodes_of_type[] = {2,  3,  4,  4, 8,  6,  5,  3,  6,  9, 10, 27, 18, 14, 1, 8,
                                 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5,  6,  20, 35, 56};

void read_format(Source& source) {
  const std::string version(source.word());
  if (version != "4.1") source.complain(fmt::format("mesh format {}; expected 4.1 (gmsh -format msh41)", version));
  const int kind = source.number_in_words<int>(), size = source.number_in_words<int>();
  if (size != 8) source.complain(fmt::format("counts of {} bytes; expected 8", size));
  if (kind != 1) return;
  source.line();
  source.become_binary();
  if (source.number<int>() != 1) source.complain("the binary file was written with the other byte order");
}

void read_physical_names(Source& source, Content& content) {
  // Words in a binary file, too.
  const int names = source.number_in_words<int>();
  for (int i = 0; i < names; ++i) {
    const int dimension = source.number_in_words<int>(), group = source.number_in_words<int>();
    const std::string_view rest = source.line();
    const std::size_t begin = rest.find('"'), end = rest.rfind('"');
    if (begin == std::string_view::npos || end == begin) source.complain("expected a name in quotation marks");
    content.group_name[{dimension, group}] = rest.substr(begin + 1, end - begin - 1);
  }
}

void read_entities(Source& source, Content& content) {
  std::array<Count, 4> entities;
  for (Count& n : entities) n = source.count();
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (Count i = 0; i < entities[dimension]; ++i) {
      const int tag = source.number<int>();
      for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) source.number<double>();
      auto& groups = content.groups[{dimension, tag}];
      for (Count n = source.count(); n > 0; --n)
        groups.push_back(std::abs(source.number<int>()));  // negative: reversed
      if (dimension == 0) continue;
      for (Count n = source.count(); n > 0; --n) source.number<int>();
    }
  }
}

void read_nodes(Source& source, Content& content) {
  const Count blocks = source.count();
  for (int k = 0; k < 3; ++k) source.number<Count>();
  for (Count i = 0; i < blocks; ++i) {
    const int dimension = source.number<int>();
    source.number<int>();
    const bool parametric = source.number<int>() != 0;
    std::vector<Count> tags(source.count());
    for (Count& tag : tags) tag = source.number<Count>();
    for (const Count tag : tags) {
      Vec3& p = content.position[tag];
      for (int axis = 0; axis < 3; ++axis) p[axis] = source.number<double>();
      for (int k = 0; k < (parametric ? dimension : 0); ++k) source.number<double>();
    }
  }
}

void read_elements(Source& source, Content& content) {
  const Count blocks = source.count();
  for (int k = 0; k < 3; ++k) source.number<Count>();
  for (Count i = 0; i < blocks; ++i) {
    Block block;
    block.dimension = source.number<int>();
    block.entity = source.number<int>();
    block.type = source.number<int>();
    if (block.type < 1 || block.type > static_cast<int>(std::size(nodes_of_type))) {
      source.complain(
          fmt::format("elements of type {}; expected hexahedra (type 5) and elements on their boundary", block.type));
    }
    if (block.dimension == 3 && block.type != hexahedron) {
      source.complain(
          fmt::format("volume {} has elements of type {}; expected hexahedra with eight nodes (type 5) alone",
                      block.entity, block.type));
    }
    for (Count n = source.count(); n > 0; --n) {
      source.number<Count>();
      for (int k = 0; k < nodes_of_type[block.type - 1]; ++k) block.tags.push_back(source.number<Count>());
    }
    content.blocks.push_back(std::move(block));
  }
}

Content read_content(Source& source) {
  if (source.word() != "$MeshFormat") source.complain("expected $MeshFormat at the start of a gmsh mesh file");
  read_format(source);
  source.skip_past("$EndMeshFormat");
  Content content;
  while (source.skip_space()) {
    const std::string section(source.word());
    if (section.size() < 2 || section[0] != '$')
      source.complain(fmt::format("expected the start of a section, found '{}'", section));
    if (section == "$PartitionedEntities") source.complain("the mesh is partitioned; expected a mesh in one part");
    // In a binary file the numbers start right after the end of the line.
    if (section != "$PhysicalNames") source.line();
    if (section == "$PhysicalNames") read_physical_names(source, content);
    if (section == "$Entities") read_entities(source, content);
    if (section == "$Nodes") read_nodes(source, content);
    if (section == "$Elements") read_elements(source, content);
    source.skip_past("$End" + section.substr(1));
  }
  return content;
}

/// Numbers the nodes of hexahedra in the order in which elements first name them.
class Numbering {
 public:
  int number(Count tag) { return numbers_.try_emplace(tag, static_cast<int>(numbers_.size())).first->second; }
  /// -1 for a node of no hexahedron.
  int find(Count tag) const {
    const auto found = numbers_.find(tag);
    return found == numbers_.end() ? -1 : found->second;
  }

 private:
  std::unordered_map<Count, int> numbers_;
};

}  // namespace

HexMesh read_msh(const std::filesystem::path& file) {
  Source source(file);
  const Content content = read_content(source);
  const auto sets_of = [&](const Block& block) {
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
  for (const Block& block : content.blocks) {
    if (block.type != hexahedron) continue;
    const int first = static_cast<int>(mesh.elements.size());
    for (std::size_t i = 0; i < block.tags.size(); i += 8) {
      auto& element = mesh.elements.emplace_back();
      for (int a = 0; a < 8; ++a) {
        const auto position = content.position.find(block.tags[i + a]);
        if (position == content.position.end()) {
          throw InputError(fmt::format("{}: volume {} uses node {}, which the file does not define", file.string(),
                                       block.entity, block.tags[i + a]));
        }
        element[a] = numbering.number(block.tags[i + a]);
        if (element[a] == static_cast<int>(mesh.nodes.size())) mesh.nodes.push_back(position->second);
      }
    }
    for (const std::string& name : sets_of(block)) {
      for (int e = first; e < static_cast<int>(mesh.elements.size()); ++e) mesh.element_sets[name].push_back(e);
    }
  }
  if (mesh.elements.empty())
    throw InputError(fmt::format("{}: no hexahedra; expected elements of type 5", file.string()));

  for (const Block& block : content.blocks) {
    for (const std::string& name : sets_of(block)) {
      for (const Count tag : block.tags) {
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
