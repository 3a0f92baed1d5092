// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <type_traits>

#include "app/value.hpp"
#include "core/error.hpp"
#include "core/nearest_name.hpp"

namespace drogue::app {

namespace {

constexpr const char* any_name = "NAME";

std::string expectation(const char* type, const Range& range, const std::string& unit) {
  std::string text = type;
  if (!range.text().empty()) text += fmt::format(" {}", range.text());
  if (!unit.empty()) text += fmt::format(" [{}]", unit);
  return text;
}

/// Stands for a required value while describing.
template <class T>
T blank() {
  if constexpr (std::is_same_v<T, Vec3>) {
    return Vec3::Zero();
  } else {
    return T{};
  }
}

}  // namespace

bool Range::holds(double value) const { return open ? value > min && value < max : value >= min && value <= max; }

std::string Range::text() const {
  const bool has_min = std::isfinite(min), has_max = std::isfinite(max);
  if (has_min && has_max) {
    return open ? fmt::format("between {} and {}", min, max) : fmt::format("from {} to {}", min, max);
  }
  if (has_min) return fmt::format("{} {}", open ? "above" : "of at least", min);
  if (has_max) return fmt::format("{} {}", open ? "below" : "of at most", max);
  return "";
}

Section::Section(const Document& document, Record& record)
    : document_(&document), record_(&record), own_(nullptr), table_(&document.root) {
  own_ = &record_->sections.emplace_back();
}

Section::Section(const Section& parent, const toml::table* table, const Place& place, const std::string& doc)
    : document_(parent.document_),
      record_(parent.record_),
      own_(nullptr),
      table_(table),
      path_(place.path),
      schema_(place.schema),
      header_(place.header) {
  const auto described = std::ranges::find(record_->sections, schema_, &SectionRecord::path);
  if (describing() && described != record_->sections.end()) {
    own_ = &*described;
    return;
  }
  own_ = &record_->sections.emplace_back();
  own_->path = schema_;
  own_->header = place.is_element ? fmt::format("[[{}]]", header_) : fmt::format("[{}]", header_);
  own_->doc = doc;
}

const toml::node* Section::present(const std::string& name) {
  const toml::node* found = node(name);
  if (found) {
    record_->read.insert(found);
    record_->origin[path(name)] = location(found, document_->file);
  }
  return found;
}

std::string Section::where(const std::string& name) const {
  return location(has(name) ? node(name) : table_, document_->file);
}

void Section::fail(const std::string& name, const std::string& message) const {
  if (!describing()) throw InputError(fmt::format("{}: {} {}", where(name), path(name), message));
}

template <class T>
std::optional<T> Section::look_up(const std::string& name, const Key<T>& key, const std::string& wanted,
                                  bool required) {
  std::optional<T> value = key.derived && !describing() ? key.derived : key.fallback;
  if (const toml::node* given = present(name)) {
    value.emplace();
    try {
      read_value(*given, *value);
    } catch (const InputError& error) {
      fail(name, fmt::format("= {}; expected {}", error.what(), wanted));
    }
    if (!std::ranges::all_of(numbers(*value), [&](double number) { return key.range.holds(number); })) {
      fail(name, fmt::format("= {} is out of range; expected {}", text_of(*given), wanted));
    }
    if constexpr (std::is_same_v<T, std::filesystem::path>) {
      *value = std::filesystem::absolute(folder_of(*given, document_->file) / *value).lexically_normal();
    }
  }
  if (required && !value) fail(name, fmt::format("is missing; expected {}: {}", wanted, key.doc));
  const bool described = std::ranges::find(own_->keys, name, &KeyRecord::name) != own_->keys.end();
  if (describing() && described) return value;
  own_->keys.push_back({.name = name,
                        .expected = wanted,
                        .unit = key.unit,
                        .doc = key.doc,
                        .fallback = key.fallback  ? write_value(*key.fallback)
                                    : key.derived ? "derived"
                                                  : "",
                        .required = required && !key.fallback && !key.derived,
                        .value = value ? std::optional(write_value(*value)) : std::nullopt});
  return value;
}

template <class T>
std::optional<T> Section::find(const std::string& name, const Key<T>& key) {
  return look_up(name, key, expectation(expected<T>, key.range, key.unit), false);
}

template <class T>
T Section::get(const std::string& name, const Key<T>& key) {
  return look_up(name, key, expectation(expected<T>, key.range, key.unit), true).value_or(blank<T>());
}

std::size_t Section::index_of(const std::string& name, const std::vector<std::string>& words,
                              const Key<std::string>& key) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) list += i + 1 == words.size() ? " or " : ", ";
    list += fmt::format("\"{}\"", words[i]);
  }
  const std::string value = look_up(name, key, list, true).value_or(words.front());
  const auto found = std::ranges::find(words, value);
  if (found == words.end()) {
    fail(name, fmt::format("= \"{}\" is not known; expected {}{}", value, list, did_you_mean(value, words)));
  }
  return static_cast<std::size_t>(found - words.begin());
}

Section Section::section(const std::string& name, const std::string& doc) {
  const toml::node* given = present(name);
  if (given && !given->is_table()) {
    fail(name, fmt::format("= {} is {}; expected a table", text_of(*given), kind_of(*given)));
  }
  const Place place{path(name), join_key(schema_, name), join_key(header_, name)};
  return Section(*this, given ? given->as_table() : nullptr, place, doc);
}

void Section::each(const std::string& name, const std::string& doc, const std::function<void(Section&)>& visit) {
  Place place{path(name), join_key(schema_, name), join_key(header_, name), true};
  if (describing()) {
    Section element(*this, nullptr, place, doc);
    visit(element);
    return;
  }
  const toml::node* given = present(name);
  if (!given) return;
  const toml::array* array = given->as_array();
  if (!array) fail(name, fmt::format("is {}; expected [[{}]], an array of tables", kind_of(*given), place.header));
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::table* table = (*array)[i].as_table();
    if (!table) fail(name, fmt::format("holds {}; expected tables", kind_of((*array)[i])));
    const auto own_name = (*table)["name"].value<std::string>();
    place.path = join_key(path(name), own_name ? *own_name : fmt::format("{}", i));
    record_->origin[place.path] = location(table, document_->file);
    record_->read.insert(table);
    Section element(*this, table, place, doc);
    visit(element);
  }
}

void Section::each_named(const std::string& doc, const std::function<void(const std::string&, Section&)>& visit) {
  if (describing()) {
    Section element(*this, nullptr,
                    {join_key(path_, any_name), join_key(schema_, any_name), join_key(header_, any_name)}, doc);
    visit(any_name, element);
    return;
  }
  if (!table_) return;
  for (const auto& [key, value] : *table_) {
    const std::string name(key.str());
    present(name);
    if (!value.is_table()) fail(name, fmt::format("= {} is {}; expected a table", text_of(value), kind_of(value)));
    Section element(*this, value.as_table(), {path(name), join_key(schema_, any_name), join_key(header_, name)}, doc);
    visit(name, element);
  }
}

template bool Section::get(const std::string&, const Key<bool>&);
template int Section::get(const std::string&, const Key<int>&);
template double Section::get(const std::string&, const Key<double>&);
template Pair Section::get(const std::string&, const Key<Pair>&);
template Vec3 Section::get(const std::string&, const Key<Vec3>&);
template Index2 Section::get(const std::string&, const Key<Index2>&);
template Corners Section::get(const std::string&, const Key<Corners>&);
template Index3 Section::get(const std::string&, const Key<Index3>&);
template Formulas Section::get(const std::string&, const Key<Formulas>&);
template Expression Section::get(const std::string&, const Key<Expression>&);
template std::string Section::get(const std::string&, const Key<std::string>&);
template std::filesystem::path Section::get(const std::string&, const Key<std::filesystem::path>&);
template std::optional<double> Section::find(const std::string&, const Key<double>&);
template std::optional<Pair> Section::find(const std::string&, const Key<Pair>&);
template std::optional<Box> Section::find(const std::string&, const Key<Box>&);
template std::optional<Expression> Section::find(const std::string&, const Key<Expression>&);
template std::optional<Formulas> Section::find(const std::string&, const Key<Formulas>&);
template std::optional<std::filesystem::path> Section::find(const std::string&, const Key<std::filesystem::path>&);
template std::optional<std::string> Section::find(const std::string&, const Key<std::string>&);

}  // namespace drogue::app
