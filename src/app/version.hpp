// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace drogue::app {

#ifdef DROGUE_VERSION
inline constexpr const char* version = DROGUE_VERSION;  // from the build
#else
inline constexpr const char* version = "0.1.0";
#endif

}  // namespace drogue::app
