// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "core/error.hpp"
#include "io/fluid_snapshot.hpp"
#include "render/scene.hpp"

namespace drogue::render {
namespace {

void read_frames_csv(const std::filesystem::path& csv, RunFolder& run) {
  std::ifstream stream(csv);
  std::string line;
  std::getline(stream, line);
  for (int number = 2; std::getline(stream, line); ++number) {
    std::istringstream row(line);
    std::string kind, index, time, file;
    std::getline(row, kind, ',');
    std::getline(row, index, ',');
    std::getline(row, time, ',');
    std::getline(row, file, ',');
    if (file.empty())
      throw InputError(fmt::format("{}:{}: expected kind,index,time,file, found \"{}\"", csv.string(), number, line));
    const Frame frame{std::stod(time), run.folder / file};
    if (!std::filesystem::exists(frame.file)) continue;
    if (kind.starts_with("canopy")) run.canopy.push_back(frame);
    if (kind == "fluid") run.fluid.push_back(frame);
  }
}

void scan_names(RunFolder& run) {
  for (const auto& entry : std::filesystem::directory_iterator(run.folder)) {
    const std::filesystem::path file = entry.path();
    const std::string name = file.filename().string(), suffix = file.extension().string();
    if (name.starts_with("canopy") && suffix == ".vtu") run.canopy.push_back({read_canopy_time(file), file});
    if (name.starts_with("fluid") && (suffix == ".vtkhdf" || suffix == ".hdf"))
      run.fluid.push_back({io::read_fluid_time(file), file});
  }
}

}  // namespace

double RunFolder::last_time() const {
  return std::max(canopy.empty() ? 0.0 : canopy.back().time, fluid.empty() ? 0.0 : fluid.back().time);
}

RunFolder open_run(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) throw InputError(fmt::format("{} is not a run folder", folder.string()));
  RunFolder run{folder, {}, {}};
  if (std::filesystem::exists(folder / "frames.csv"))
    read_frames_csv(folder / "frames.csv", run);
  else
    scan_names(run);
  if (run.canopy.empty() && run.fluid.empty())
    throw InputError(fmt::format("{} holds no snapshots: expected canopy_*.vtu or fluid_*.hdf", folder.string()));
  const auto earlier = [](const Frame& a, const Frame& b) {
    return a.time != b.time ? a.time < b.time : a.file < b.file;
  };
  std::sort(run.canopy.begin(), run.canopy.end(), earlier);
  std::sort(run.fluid.begin(), run.fluid.end(), earlier);
  return run;
}

std::vector<Frame> nearest(const std::vector<Frame>& frames, double time) {
  const auto distance = [&](const Frame& frame) { return std::abs(frame.time - time); };
  const auto best = std::min_element(frames.begin(), frames.end(),
                                     [&](const Frame& a, const Frame& b) { return distance(a) < distance(b); });
  std::vector<Frame> found;
  for (const Frame& frame : frames)
    if (frame.time == best->time) found.push_back(frame);
  return found;
}

}  // namespace drogue::render
