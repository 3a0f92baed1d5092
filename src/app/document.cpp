// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/document.hpp"

#include <fmt/format.h>

#include <charconv>
#include <sstream>
#include <string_view>
#include <utility>

#include "app/value.hpp"
#include "core/error.hpp"

namespace drogue::app {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view override_prefix = "--set ";

bool came_from_override(const toml::node& node) {
  return node.source().path && node.source().path->starts_with(override_prefix);
}

toml::table* named_element(toml::array& array, std::string_view name) {
  for (toml::node& element : array) {
    toml::table* table = element.as_table();
    if (table && (*table)["name"].value<std::string_view>() == name) return table;
  }
  return nullptr;
}

bool elements_have_names(const toml::node& node) {
  const toml::array* array = node.as_array();
  if (!array || array->empty()) return false;
  for (const toml::node& element : *array) {
    if (!element.is_table() || !(*element.as_table())["name"].is_string()) return false;
  }
  return true;
}

void merge(toml::table& base, toml::table&& own) {
  for (auto&& [key, value] : own) {
    toml::node* old = base.get(key.str());
    if (old && old->is_table() && value.is_table()) {
      merge(*old->as_table(), std::move(*value.as_table()));
    } else if (old && elements_have_names(*old) && elements_have_names(value)) {
      for (toml::node& element : *value.as_array()) {
        toml::table& table = *element.as_table();
        toml::table* counterpart = named_element(*old->as_array(), *table["name"].value<std::string_view>());
        if (counterpart) {
          merge(*counterpart, std::move(table));
        } else {
          old->as_array()->push_back(std::move(table));
        }
      }
    } else {
      base.insert_or_assign(key.str(), std::move(value));
    }
  }
}

toml::table parse_file(const fs::path& file, int depth) {
  if (!fs::is_regular_file(file)) throw InputError(fmt::format("{} does not exist or is no file", file.string()));
  if (depth > 8) throw InputError(fmt::format("{}: base files refer to each other in a circle", file.string()));
  toml::table own;
  try {
    own = toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    throw InputError(
        fmt::format("{}:{}: not valid TOML: {}", file.string(), error.source().begin.line, error.description()));
  }
  const toml::node* base = own.get("base");
  if (!base) return own;
  const auto name = base->value<std::string>();
  if (!name) {
    throw InputError(fmt::format("{}: base = {} is {}; expected the name of a case file", location(base, file),
                                 text_of(*base), kind_of(*base)));
  }
  fs::path base_file = (file.parent_path() / *name).lexically_normal();
  if (fs::is_directory(base_file)) base_file /= "case.toml";
  if (!fs::is_regular_file(base_file)) {
    throw InputError(fmt::format("{}: base = \"{}\" does not exist", location(base, file), *name));
  }
  toml::table whole = parse_file(base_file, depth + 1);
  own.erase("base");
  merge(whole, std::move(own));
  return whole;
}

/// The value of an override, wrapped in a table so that it keeps its origin. What is not TOML is a string.
toml::table parse_value(std::string_view text, const std::string& origin) {
  try {
    return toml::parse(fmt::format("value = {}", text), origin);
  } catch (const toml::parse_error&) {
    toml::table quoted = toml::parse("value = ''", origin);
    quoted["value"].ref<std::string>() = std::string(text);
    return quoted;
  }
}

toml::node* element(toml::array& array, const std::string& name) {
  if (toml::table* table = named_element(array, name)) return table;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
  const bool is_index = error == std::errc() && end == name.data() + name.size() && index < array.size();
  return is_index ? array.get(index) : nullptr;
}

/// One step down a dotted path; makes the tables that are not there yet.
toml::node& descend(toml::node& node, const std::string& name, const std::string& so_far, const std::string& origin) {
  if (toml::table* table = node.as_table()) {
    if (!table->contains(name)) table->insert_or_assign(name, toml::parse("", origin));  // errors in it name its origin
    return *table->get(name);
  }
  if (toml::array* array = node.as_array()) {
    if (toml::node* found = element(*array, name)) return *found;
    throw InputError(fmt::format("{}: {} has no element \"{}\"", origin, so_far, name));
  }
  throw InputError(fmt::format("{}: {} is {} and has no key \"{}\"", origin, so_far, kind_of(node), name));
}

void assign(toml::node& node, const std::string& name, toml::node&& value, const std::string& so_far,
            const std::string& origin) {
  if (toml::table* table = node.as_table()) {
    table->insert_or_assign(name, std::move(value));
    return;
  }
  toml::array* array = node.as_array();
  toml::node& old = descend(node, name, so_far, origin);
  auto place = array->cbegin();
  while (&*place != &old) ++place;
  array->replace(place, std::move(value));
}

void apply_override(toml::table& root, const std::string& assignment) {
  const std::string origin = std::string(override_prefix) + assignment;
  const std::size_t equals = assignment.find('=');
  std::string key = assignment.substr(0, equals);
  key.erase(key.find_last_not_of(' ') + 1);
  const bool nameless = key.empty() || key.starts_with('.') || key.ends_with('.') || key.find("..") != key.npos;
  if (nameless || equals == std::string::npos) throw InputError(fmt::format("{}: expected key=value", origin));
  toml::table value = parse_value(std::string_view(assignment).substr(equals + 1), origin);

  toml::node* node = &root;
  std::string so_far;
  std::size_t begin = 0;
  for (std::size_t dot = key.find('.'); dot != std::string::npos; dot = key.find('.', begin)) {
    const std::string name = key.substr(begin, dot - begin);
    node = &descend(*node, name, so_far, origin);
    so_far += (so_far.empty() ? "" : ".") + name;
    begin = dot + 1;
  }
  assign(*node, key.substr(begin), std::move(*value.get("value")), so_far, origin);
}

}  // namespace

Document load_document(const fs::path& file, const std::vector<std::string>& overrides) {
  Document document{file, parse_file(file, 0)};
  for (const std::string& assignment : overrides) apply_override(document.root, assignment);
  return document;
}

std::string location(const toml::node* node, const fs::path& file) {
  if (!node || !node->source().path) return file.string();
  if (came_from_override(*node)) return *node->source().path;
  return fmt::format("{}:{}", *node->source().path, node->source().begin.line);
}

fs::path folder_of(const toml::node& node, const fs::path& file) {
  if (came_from_override(node)) return fs::current_path();
  return node.source().path ? fs::path(*node.source().path).parent_path() : file.parent_path();
}

std::string text_of(const toml::node& node) {
  if (const toml::array* array = node.as_array()) {
    std::vector<std::string> elements;
    for (const toml::node& element : *array) elements.push_back(text_of(element));
    return fmt::format("[{}]", fmt::join(elements, ", "));
  }
  if (node.is_table()) return "{...}";
  if (node.is_string()) return write_value(**node.as_string());
  if (node.is_floating_point()) return write_value(**node.as_floating_point());
  std::ostringstream out;
  node.visit([&](const auto& value) { out << value; });
  return out.str();
}

std::string kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

}  // namespace drogue::app
