// SPDX-License-Identifier: GPL-3.0-or-later
// Guesses what a mistyped name was meant to be.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace drogue {

/// Insertions, deletions, replacements and swaps of neighbours that turn one word into the other (optimal string
/// alignment).
int edit_distance(std::string_view a, std::string_view b);

/// The candidate closest to `name` (the first of equals), or an empty string if none resembles it.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// "; did you mean X?", or nothing.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

}  // namespace drogue
