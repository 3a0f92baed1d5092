// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/error.hpp"
#include "core/nearest_name.hpp"

namespace drogue::app {

namespace {

/// The declared keys of one table, and those of the tables in it by name.
struct Level {
  std::map<std::string, const KeyRecord*> keys;
  std::map<std::string, Level> tables;

  const Level* table(const std::string& name) const {
    const auto found = tables.find(tables.contains(name) ? name : "NAME");
    return found == tables.end() ? nullptr : &found->second;
  }
  std::vector<std::string> names(const std::string& prefix) const {
    std::vector<std::string> all;
    for (const auto& [name, key] : keys) all.push_back(join_key(prefix, name));
    for (const auto& [name, level] : tables) all.push_back(join_key(prefix, name));
    return all;
  }
};

Level tree_of(const Record& schema) {
  Level root;
  for (const SectionRecord& section : schema.sections) {
    Level* level = &root;
    for (std::size_t begin = 0; begin < section.path.size();) {
      const std::size_t end = std::min(section.path.find('.', begin), section.path.size());
      level = &level->tables[section.path.substr(begin, end - begin)];
      begin = end + 1;
    }
    for (const KeyRecord& key : section.keys) level->keys.emplace(key.name, &key);
  }
  return root;
}

/// Calls `visit(path, name, node, level)` for every key of the document, tables before what they hold, in file order.
using Visit = std::function<void(const std::string& path, const std::string& name, const toml::node&, const Level&)>;

void walk(const toml::table& table, const std::string& path, const Level& level, const Visit& visit) {
  std::vector<std::pair<std::string, const toml::node*>> entries;
  for (const auto& [key, node] : table) entries.emplace_back(key.str(), &node);
  std::ranges::stable_sort(entries, {}, [](const auto& entry) { return entry.second->source().begin.line; });
  for (const auto& [name, node] : entries) {
    visit(path, name, *node, level);
    const Level* below = level.table(name);
    if (!below) continue;
    if (const toml::table* inner = node->as_table()) walk(*inner, join_key(path, name), *below, visit);
    const toml::array* array = node->as_array();
    for (std::size_t i = 0; array && i < array->size(); ++i) {
      const toml::table* element = (*array)[i].as_table();
      if (!element) continue;
      const auto own_name = (*element)["name"].value<std::string>();
      walk(*element, join_key(join_key(path, name), own_name ? *own_name : fmt::format("{}", i)), *below, visit);
    }
  }
}

/// Where else a key of this name is known: "; did you mean fluid.viscosity?"
std::string known_elsewhere(const Record& schema, const std::string& name) {
  for (const SectionRecord& section : schema.sections) {
    for (const KeyRecord& key : section.keys) {
      if (key.name == name) return fmt::format("; did you mean {}?", join_key(section.path, name));
    }
  }
  return "";
}

std::string comment(const KeyRecord& key) {
  return key.unit.empty() ? fmt::format("# {}", key.doc) : fmt::format("# [{}] {}", key.unit, key.doc);
}

}  // namespace

std::string join_key(const std::string& path, const std::string& name) {
  return path.empty() ? name : fmt::format("{}.{}", path, name);
}

void refuse_unknown_keys(const Document& document, const Record& schema) {
  const Visit check = [&](const std::string& path, const std::string& name, const toml::node& node,
                          const Level& level) {
    if (level.keys.contains(name) || level.table(name)) return;
    const std::string full = join_key(path, name);
    std::string hint = did_you_mean(full, level.names(path));
    if (hint.empty()) hint = known_elsewhere(schema, name);
    throw InputError(fmt::format("{}: {} is not a known key{}", location(&node, document.file), full, hint));
  };
  walk(document.root, "", tree_of(schema), check);
}

void refuse_unread_keys(const Document& document, const Record& record, const Record& schema) {
  const Visit check = [&](const std::string& path, const std::string& name, const toml::node& node,
                          const Level& level) {
    if (record.read.contains(&node)) return;
    const auto key = level.keys.find(name);
    const std::string doc = key == level.keys.end() ? "" : fmt::format(" ({})", key->second->doc);
    throw InputError(
        fmt::format("{}: {} has no effect here{}", location(&node, document.file), join_key(path, name), doc));
  };
  walk(document.root, "", tree_of(schema), check);
}

std::string to_toml(const Record& record) {
  std::string text = "# The case as it ran: every key with the value in use.\n";
  for (const SectionRecord& section : record.sections) {
    if (!section.path.empty()) text += fmt::format("\n{}  # {}\n", section.header, section.doc);
    for (const KeyRecord& key : section.keys) {
      const std::string line = key.value ? fmt::format("{} = {}", key.name, *key.value) : "# " + key.name;
      text += fmt::format("{:<44} {}\n", line, comment(key));
    }
  }
  return text;
}

}  // namespace drogue::app
