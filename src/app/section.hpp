// SPDX-License-Identifier: GPL-3.0-or-later
// One table of a case file while it is read. A key is declared where it is read, with unit, default, range and meaning,
// and nowhere else: the same call checks and returns its value, puts it into the resolved case, and, when the reader is
// run over nothing at all ("describing"), into the list of all keys; a key that several readers share is listed once.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/document.hpp"
#include "app/record.hpp"

namespace drogue::app {

/// Where every number of a value must lie; `open` leaves the bounds themselves out.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open = false;

  bool holds(double value) const;
  std::string text() const;  ///< "above 0", "from 0 to 1", or nothing
};
inline constexpr Range positive{.min = 0.0, .open = true};
inline constexpr Range not_negative{.min = 0.0};

/// What is said of a key of type T where it is declared.
template <class T>
struct Key {
  std::string unit{};
  std::string doc{};
  std::optional<T> fallback{};
  std::optional<T> derived{};  ///< a fallback that follows from other values of the case
  Range range{};
};

template <class E>
using Choices = std::vector<std::pair<std::string, E>>;
inline const Choices<int> axes{{"x", 0}, {"y", 1}, {"z", 2}};

class Section {
 public:
  Section(const Document& document, Record& record);

  /// The value of a key, or its default. Throws InputError naming file, line, key, value and what was expected.
  template <class T>
  T get(const std::string& name, const Key<T>& key);
  /// The value of a key that may be absent.
  template <class T>
  std::optional<T> find(const std::string& name, const Key<T>& key);
  /// One of a closed list of words.
  template <class E>
  E choose(const std::string& name, const Choices<E>& choices, const Key<std::string>& key) {
    std::vector<std::string> words;
    for (const auto& choice : choices) words.push_back(choice.first);
    return choices[index_of(name, words, key)].second;
  }

  /// A table; an absent one reads as empty.
  Section section(const std::string& name, const std::string& doc);
  /// Visits the elements of an array of tables; one, empty, when describing.
  void each(const std::string& name, const std::string& doc, const std::function<void(Section&)>& visit);
  /// Visits all tables in this one, whatever their names; one called NAME when describing.
  void each_named(const std::string& doc, const std::function<void(const std::string&, Section&)>& visit);

  bool describing() const { return record_->describing; }
  bool has(const std::string& name) const { return node(name) != nullptr; }
  bool has_table(const std::string& name) const { return has(name) && node(name)->is_table(); }
  std::string path(const std::string& name) const { return join_key(path_, name); }
  /// Throws InputError "file:line: key <message>"; does nothing when describing.
  void fail(const std::string& name, const std::string& message) const;

 private:
  struct Place {
    std::string path, schema, header;
    bool is_element = false;
  };
  Section(const Section& parent, const toml::table* table, const Place& place, const std::string& doc);
  const toml::node* node(const std::string& name) const { return table_ ? table_->get(name) : nullptr; }
  const toml::node* present(const std::string& name);
  template <class T>
  std::optional<T> look_up(const std::string& name, const Key<T>& key, const std::string& wanted, bool required);
  std::string where(const std::string& name) const;
  std::size_t index_of(const std::string& name, const std::vector<std::string>& words, const Key<std::string>& key);

  const Document* document_;
  Record* record_;
  SectionRecord* own_;
  const toml::table* table_;
  std::string path_;    // as a user writes it: "body.plate.material"
  std::string schema_;  // without names of elements: "body.material"
  std::string header_;  // as a table header: "body.material", "reference.cd_stable"
};

}  // namespace drogue::app
