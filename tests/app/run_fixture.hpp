// SPDX-License-Identifier: GPL-3.0-or-later
// The small plate, run in a folder of its own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/run.hpp"
#include "case_folder.hpp"
#include "core/error.hpp"

namespace drogue::app {

class RunTest : public testing::Test {
 protected:
  RunTest() {
    folder_.write("case.toml", plate_case);
    options_.path = folder_.path();
    options_.folder = folder_.path() / "run";
    options_.until = 0.025;  // eight coarse steps
    options_.quiet = true;
  }
  nlohmann::json summary() const { return nlohmann::json::parse(std::ifstream(options_.folder / "summary.json")); }
  std::vector<std::string> lines(const std::string& file) const {
    std::vector<std::string> lines;
    std::ifstream stream(options_.folder / file);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
  }
  std::vector<std::string> history() const { return lines("history.csv"); }
  /// Without the last column, which is the speed.
  std::vector<std::string> reproducible_history() const {
    std::vector<std::string> rows = history();
    for (std::string& row : rows) row.resize(row.rfind(','));
    return rows;
  }
  template <class Error = InputError>
  std::string error() {
    try {
      run_case(options_);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  CaseFolder folder_;
  RunOptions options_;
};

}  // namespace drogue::app
