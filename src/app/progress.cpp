// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace drogue::app {

namespace {

constexpr double seconds_between_draws = 0.2;

int twentieths(double share) { return static_cast<int>(20.0 * share + 1e-9); }

std::string duration(double seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{}:{:02d} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02d} h", whole / 3600, whole / 60 % 60);
}

}  // namespace

Progress::Progress(double begin, double end, bool quiet)
    : begin_(begin), end_(end), quiet_(quiet), live_(isatty(STDOUT_FILENO) == 1), shown_(twentieths(begin / end)) {}

Progress::~Progress() { clear(); }

void Progress::update(double time, double mlups, std::optional<double> c_d) {
  if (quiet_) return;
  const double share = time / end_, now = elapsed_.seconds();
  if (live_) {
    if (now - last_draw_ < seconds_between_draws) return;
    last_draw_ = now;
  } else {
    const int reached = twentieths(share);
    if (reached <= shown_) return;
    shown_ = reached;
  }
  std::string line = fmt::format("{:4.0f} %   t = {:.4g} s", 100.0 * share, time);
  if (mlups > 0.0) line += fmt::format("   {:.0f} MLUPS", mlups);
  if (c_d) line += fmt::format("   C_D {:.3f}", *c_d);
  line += fmt::format("   {} left", duration(time > begin_ ? now * (end_ - time) / (time - begin_) : 0.0));
  if (live_) {
    fmt::print("\r\033[K{}", line);
    line_open_ = true;
  } else {
    fmt::print("{}\n", line);
  }
  std::fflush(stdout);
}

void Progress::clear() {
  if (!line_open_) return;
  fmt::print("\r\033[K");
  std::fflush(stdout);
  line_open_ = false;
}

}  // namespace drogue::app
