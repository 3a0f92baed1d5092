// SPDX-License-Identifier: GPL-3.0-or-later
// Keys that bodies of several kinds share.
#pragma once

#include <optional>
#include <string>

#include "app/section.hpp"
#include "app/value.hpp"
#include "ib/delta.hpp"

namespace drogue::app {

inline constexpr const char* coupling_doc = "between body and fluid";

std::string read_name(Section& body);
/// `area` [m^2] by default.
double read_reference_area(Section& body, const std::optional<double>& area);
ib::Delta read_delta(Section& coupling);

/// Three formulas of time; zero by default. Throws InputError if one depends on the place.
Formulas read_formulas_of_time(Section& section, const std::string& name, const Key<Formulas>& key);

/// Throws InputError if the formula depends on the place.
void expect_time_alone(const Section& section, const std::string& name, const Expression& formula);

}  // namespace drogue::app
