// SPDX-License-Identifier: GPL-3.0-or-later
// Reads and validates a case file. The only part of Drogue that knows TOML keys.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/case.hpp"
#include "app/record.hpp"

namespace drogue::app {

/// `path` is a case folder or a case file; `overrides` are "dotted.key=value". Throws InputError: one sentence with
/// file, line, key, value and what was expected.
Case read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

/// Every key there is, in the order of the file.
Record describe_case();

}  // namespace drogue::app
