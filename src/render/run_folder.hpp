// SPDX-License-Identifier: GPL-3.0-or-later
// What a run left behind: snapshots of the canopy and of the flow with their times.
#pragma once

#include <filesystem>
#include <vector>

namespace drogue::render {

struct Frame {
  double time;  ///< [s]
  std::filesystem::path file;
};

struct RunFolder {
  std::filesystem::path folder;
  std::vector<Frame> canopy, fluid;  ///< in the order of time; several bodies give several canopy frames at a time

  double last_time() const;  ///< [s] of the latest frame of either kind
};

/// Reads frames.csv (kind,index,time[s],file; kind fluid, canopy or canopy_NAME); without it finds canopy_*.vtu and
/// fluid_*.vtkhdf (or .hdf) by name and asks the files for their times. Throws InputError if the folder is missing or
/// holds no snapshots.
RunFolder open_run(const std::filesystem::path& folder);

/// The frames of the instant nearest to `time`; empty if there are none.
std::vector<Frame> nearest(const std::vector<Frame>& frames, double time);

}  // namespace drogue::render
