// SPDX-License-Identifier: GPL-3.0-or-later
// What is left of a run when it ends: summary.json, and a table for the reader.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/results.hpp"
#include "core/log.hpp"

namespace drogue::app {

enum class Ending { finished, interrupted, diverged, failed };

struct Summary {
  std::string case_name, title, fluid, version;
  int threads = 1;
  Ending ending = Ending::failed;
  std::string message;  ///< why, if it did not finish
  double t_end = 0.0;   ///< [s] reached
  double wall_seconds = 0.0;
  std::int64_t cell_updates = 0;
  double mlups = 0.0;  ///< million cell updates a second, while stepping
  std::int64_t peak_rss_bytes = 0;
  std::vector<std::int64_t> cells_per_level;
  std::vector<std::pair<std::string, double>> time_share;      ///< parts of the wall time, which add up to 1
  std::vector<std::pair<std::string, std::string>> structure;  ///< of each body: how it moved or came to rest
  std::vector<std::string> warnings;
  std::vector<Result> results;
  std::vector<Comparison> references;
};

std::string to_json(const Summary& summary);
/// Throws std::runtime_error naming the file.
void write_summary(const Summary& summary, const std::filesystem::path& file);
/// What the summary of a run says of its cost and its results; those without a value are left out.
struct RunNumbers {
  std::map<std::string, double> results;
  double step_seconds = 0.0, cell_updates = 0.0;
};
/// Throws std::runtime_error if the file is no summary.
RunNumbers read_numbers(const std::filesystem::path& file);
void print_summary(const Summary& summary, Log& log);

}  // namespace drogue::app
