// SPDX-License-Identifier: GPL-3.0-or-later
// ParaView's file series: a JSON list of files with their times, named `fluid.hdf.series`, `canopy.vtu.series`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drogue::io {

struct SeriesEntry {
  std::string name;  ///< relative to the folder of the series
  double time;       ///< [s]
};

/// Appends a file. Throws std::runtime_error naming the series if it cannot be read or written.
void append_to_series(const std::filesystem::path& series, const std::string& name, double time);

/// Drops the entries after `time` [s] and removes their files: a continued run writes them again. Throws like
/// append_to_series.
void cut_series(const std::filesystem::path& series, double time);

/// Empty if there is no such file.
std::vector<SeriesEntry> read_series(const std::filesystem::path& series);

}  // namespace drogue::io
