// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/error.hpp"

#include <fmt/format.h>

namespace drogue {

Diverged::Diverged(const std::string& what, double time, int level, int block, const Index3& cell, const Vec3& position)
    : std::runtime_error(fmt::format("{} at time {:.6g} s, level {}, block {}, cell ({}, {}, {}), position ({:.6g}, "
                                     "{:.6g}, {:.6g}) m",
                                     what, time, level, block, cell[0], cell[1], cell[2], position.x(), position.y(),
                                     position.z())) {}

}  // namespace drogue
