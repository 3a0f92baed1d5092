// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a run can be continued with a case.
#pragma once

#include <filesystem>
#include <string>

namespace drogue::app {

/// Throws InputError unless `folder` holds a run of this case; when it ends and what it shows may have changed, all
/// other keys that did are named. `resolved` is the case as TOML.
void expect_same_case(const std::filesystem::path& folder, const std::string& resolved);

}  // namespace drogue::app
