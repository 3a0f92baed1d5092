// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <functional>

#include "app/case.hpp"
#include "app/case_reader.hpp"
#include "app/inspect.hpp"
#include "core/error.hpp"
#include "core/nearest_name.hpp"

namespace drogue::app {

namespace {

/// The sides of the domain have the same keys: without being asked, one stands for all.
bool is_further_side(const std::string& path) {
  for (std::size_t face = 1; face < face_names.size(); ++face) {
    if (path == fmt::format("domain.{}", face_names[face])) return true;
  }
  return false;
}

bool is_inside(const std::string& path, const std::string& table) {
  return path == table || path.starts_with(table + ".");
}

std::string line(const KeyRecord& key) {
  std::string fallback = key.fallback;
  if (fallback.empty()) fallback = key.required ? "required" : "optional";
  return fmt::format("  {:<22} {:<14} {} ({})\n", key.name, fallback, key.doc, key.expected);
}

std::string listing(const Record& schema, const std::function<bool(const SectionRecord&, const KeyRecord&)>& chosen) {
  std::string text;
  for (const SectionRecord& section : schema.sections) {
    std::string lines;
    for (const KeyRecord& key : section.keys) {
      if (chosen(section, key)) lines += line(key);
    }
    if (lines.empty()) continue;
    if (!text.empty()) text += '\n';
    if (!section.path.empty()) text += fmt::format("{}  {}\n", section.header, section.doc);
    text += lines;
  }
  return text;
}

}  // namespace

std::string list_keys(const std::string& filter) {
  const Record schema = describe_case();
  if (filter.empty()) {
    return listing(schema, [](const auto& section, const auto&) { return !is_further_side(section.path); }) +
           "\nThe other sides of the domain, x_max to z_max, have the keys of x_min.\n";
  }
  std::string text = listing(schema, [&](const auto& section, const auto& key) {
    return is_inside(join_key(section.path, key.name), filter);
  });
  if (text.empty()) text = listing(schema, [&](const auto&, const auto& key) { return key.name == filter; });
  if (!text.empty()) return text;

  std::vector<std::string> names;
  for (const SectionRecord& section : schema.sections) {
    names.push_back(section.path);
    for (const KeyRecord& key : section.keys) {
      names.push_back(key.name);
      names.push_back(join_key(section.path, key.name));
    }
  }
  throw InputError(fmt::format("no key is called \"{}\"{}", filter, did_you_mean(filter, names)));
}

}  // namespace drogue::app
