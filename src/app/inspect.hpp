// SPDX-License-Identifier: GPL-3.0-or-later
// What Drogue tells without running anything. Texts for the terminal.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drogue::app {

/// `drogue check`: reads and validates a case and derives what it means: levels, steps, relaxation times, cost, masses.
/// Throws InputError.
std::string check_report(const std::filesystem::path& path, const std::vector<std::string>& overrides);

/// `drogue params`: every key with default, unit and meaning, or those that `filter` names: a table ("fluid"), a key
/// ("fluid.density") or its last part ("density"). Throws InputError with the nearest name if there is none.
std::string list_keys(const std::string& filter);

/// The processor's own name, "unknown" if it does not tell.
std::string processor_name();

/// `drogue info`: version, compiler, processor, threads, libraries.
std::string build_info();

}  // namespace drogue::app
