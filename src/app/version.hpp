// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace drogue::app {

inline constexpr const char* version = DROGUE_VERSION;  // from the build

}  // namespace drogue::app
