// SPDX-License-Identifier: GPL-3.0-or-later
// What one run of the case reader declared and found: the list of all keys, and the resolved case.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/document.hpp"

namespace drogue::app {

struct KeyRecord {
  std::string name;
  std::string expected;  ///< type, range and unit in words
  std::string unit, doc;
  std::string fallback;  ///< as TOML, or "derived"; empty if there is none
  bool required = false;
  std::optional<std::string> value;  ///< in use, as TOML; nothing if the key is absent and has no default
};

struct SectionRecord {
  std::string path;    ///< without names of elements: "body.hold", "reference.NAME"
  std::string header;  ///< as it stands in the file: "[[body.hold]]", "[reference.cd_stable]"
  std::string doc;
  std::vector<KeyRecord> keys;
};

/// What one run of the reader declared and found.
struct Record {
  bool describing = false;
  std::deque<SectionRecord> sections;  // a deque: sections keep pointers into it
  std::set<const toml::node*> read;
  std::map<std::string, std::string> origin;  ///< key -> location
};

/// "path.name", or the name alone.
std::string join_key(const std::string& path, const std::string& name);

/// Throws InputError for the first key of the document that `schema`, the record of a describing run, does not have.
void refuse_unknown_keys(const Document& document, const Record& schema);

/// Throws InputError for the first key that is known but was not read: it has no meaning beside the others.
void refuse_unread_keys(const Document& document, const Record& record, const Record& schema);

/// The record as a case file: every key with its value in use, unit and meaning.
std::string to_toml(const Record& record);

}  // namespace drogue::app
