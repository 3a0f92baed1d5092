// SPDX-License-Identifier: GPL-3.0-or-later
// Reads gmsh's MSH 4.1 format (gmsh reference manual, "MSH file format"), ASCII or binary with 8-byte counts. A section
// is read by the same code in both: a sequence of numbers of known types.
#include "geometry/msh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include "core/error.hpp"

namespace drogue::geometry {
namespace {

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
  std::uint64_t count() {
    const std::uint64_t n = number<std::uint64_t>();
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

void read_physical_names(Source& source, MshContent& content) {
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

void read_entities(Source& source, MshContent& content) {
  std::array<std::uint64_t, 4> entities;
  for (std::uint64_t& n : entities) n = source.count();
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (std::uint64_t i = 0; i < entities[dimension]; ++i) {
      const int tag = source.number<int>();
      for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) source.number<double>();
      auto& groups = content.groups[{dimension, tag}];
      for (std::uint64_t n = source.count(); n > 0; --n)
        groups.push_back(std::abs(source.number<int>()));  // negative: reversed
      if (dimension == 0) continue;
      for (std::uint64_t n = source.count(); n > 0; --n) source.number<int>();
    }
  }
}

void read_nodes(Source& source, MshContent& content) {
  const std::uint64_t blocks = source.count();
  for (int k = 0; k < 3; ++k) source.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < blocks; ++i) {
    const int dimension = source.number<int>();
    source.number<int>();
    const bool parametric = source.number<int>() != 0;
    std::vector<std::uint64_t> tags(source.count());
    for (std::uint64_t& tag : tags) tag = source.number<std::uint64_t>();
    for (const std::uint64_t tag : tags) {
      Vec3& p = content.position[tag];
      for (int axis = 0; axis < 3; ++axis) p[axis] = source.number<double>();
      for (int k = 0; k < (parametric ? dimension : 0); ++k) source.number<double>();
    }
  }
}

void read_elements(Source& source, MshContent& content) {
  const std::uint64_t blocks = source.count();
  for (int k = 0; k < 3; ++k) source.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < blocks; ++i) {
    MshBlock block;
    block.dimension = source.number<int>();
    block.entity = source.number<int>();
    block.type = source.number<int>();
    if (block.type < 1 || block.type > static_cast<int>(std::size(nodes_of_type))) {
      source.complain(fmt::format("elements of type {}; expected types 1 to {}", block.type, std::size(nodes_of_type)));
    }
    for (std::uint64_t n = source.count(); n > 0; --n) {
      source.number<std::uint64_t>();
      for (int k = 0; k < nodes_of_type[block.type - 1]; ++k) block.tags.push_back(source.number<std::uint64_t>());
    }
    content.blocks.push_back(std::move(block));
  }
}

MshContent read_content(Source& source) {
  if (source.word() != "$MeshFormat") source.complain("expected $MeshFormat at the start of a gmsh mesh file");
  read_format(source);
  source.skip_past("$EndMeshFormat");
  MshContent content;
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

}  // namespace

const Vec3& MshContent::position_of(std::uint64_t tag, const MshBlock& block) const {
  const auto found = position.find(tag);
  if (found != position.end()) return found->second;
  constexpr const char* kinds[] = {"point", "curve", "surface", "volume"};
  throw InputError(fmt::format("{}: {} {} uses node {}, which the file does not define", file,
                               kinds[std::clamp(block.dimension, 0, 3)], block.entity, tag));
}

MshContent read_msh_content(const std::filesystem::path& file) {
  Source source(file);
  MshContent content = read_content(source);
  content.file = file.string();
  return content;
}

}  // namespace drogue::geometry
