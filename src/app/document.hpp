// SPDX-License-Identifier: GPL-3.0-or-later
// A case file as it was written: TOML, on top of the file it names as `base`, with the command line's `--set` on top.
// Every value remembers where it came from.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <string>
#include <vector>

namespace drogue::app {

struct Document {
  std::filesystem::path file;
  toml::table root;
};

/// Reads a case file. Tables of `base` are completed and overridden by the file's own; arrays of tables whose elements
/// have a `name` are merged by it, other arrays replaced. `overrides` are "dotted.key=value"; an element of an array is
/// addressed by its name or its index. Throws InputError.
Document load_document(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// "file:line" of a value, "--set key=value" if it came from there, the file alone if it has no place.
std::string location(const toml::node* node, const std::filesystem::path& file);

/// Folder that relative file names in this value refer to.
std::filesystem::path folder_of(const toml::node& node, const std::filesystem::path& file);

/// The value on one line of TOML.
std::string text_of(const toml::node& node);

/// What kind of value it is: "a string", "a table".
std::string kind_of(const toml::node& node);

}  // namespace drogue::app
