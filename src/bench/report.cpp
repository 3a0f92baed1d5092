// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/report.hpp"

namespace drogue::bench {

std::filesystem::path repository() { return DROGUE_SOURCE_DIR; }

}  // namespace drogue::bench
