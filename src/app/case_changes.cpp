// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/case_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "app/document.hpp"
#include "app/record.hpp"
#include "core/error.hpp"

namespace drogue::app {

namespace {

constexpr std::array<std::string_view, 5> may_change{"title", "time.end", "output", "results", "reference"};

using Values = std::map<std::string, std::string>;  // key -> value as TOML

void collect(const toml::node& node, const std::string& key, Values& values) {
  if (const toml::table* table = node.as_table()) {
    for (const auto& [name, value] : *table) collect(value, join_key(key, std::string(name.str())), values);
  } else if (const toml::array* array = node.as_array(); array && array->is_array_of_tables()) {
    for (std::size_t i = 0; i < array->size(); ++i) {
      const auto name = (*array->get_as<toml::table>(i))["name"].value<std::string>();
      collect(*array->get(i), join_key(key, name.value_or(fmt::format("{}", i))), values);
    }
  } else {
    values[key] = text_of(node);
  }
}

bool matters(const std::string& key) {
  return std::ranges::none_of(
      may_change, [&](std::string_view free) { return key == free || key.starts_with(fmt::format("{}.", free)); });
}

std::string value_of(const Values& values, const std::string& key) {
  const auto found = values.find(key);
  return found == values.end() ? "absent" : found->second;
}

}  // namespace

void expect_same_case(const std::filesystem::path& folder, const std::string& resolved) {
  const std::filesystem::path file = folder / "case.resolved.toml";
  if (!std::filesystem::exists(file)) throw InputError(fmt::format("{} holds no run to continue", folder.string()));
  Values before, now;
  collect(load_document(file, {}).root, "", before);
  collect(toml::parse(resolved), "", now);

  std::set<std::string> keys;
  for (const Values* values : {&before, &now}) {
    for (const auto& [key, value] : *values) keys.insert(key);
  }
  std::vector<std::string> changes;
  for (const std::string& key : keys) {
    const std::string was = value_of(before, key), is = value_of(now, key);
    if (matters(key) && was != is) changes.push_back(fmt::format("{} was {} and is {}", key, was, is));
  }
  if (changes.empty()) return;
  throw InputError(fmt::format(
      "{} holds the run of another case: {}; only {} may change in a run that is continued, so give --force "
      "to replace it, or another folder with -o",
      folder.string(), fmt::join(changes, ", "), fmt::join(may_change, ", ")));
}

}  // namespace drogue::app
