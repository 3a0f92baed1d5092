// SPDX-License-Identifier: GPL-3.0-or-later
// What must hold between the values of a case for it to be run. Every function throws InputError.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "app/case.hpp"

namespace drogue::app {

/// Everything that can be told without meshes and grid.
void check_case(const Case& c);

/// Places [m] of a `part` of the body ("node of ...") must lie in the domain, and in finest-level blocks with the delta
/// function's margin.
void check_body_in_grid(const Case& c, const Body& body, const std::string& part, std::span<const Vec3> places,
                        const amr::Forest& forest);

/// Does something; an InputError about it is thrown again with file, line and key.
void at_key(const Case& c, const std::string& key, const std::function<void()>& action);

/// Throws InputError "file:line: key <message>".
[[noreturn]] void fail(const Case& c, const std::string& key, const std::string& message);

}  // namespace drogue::app
