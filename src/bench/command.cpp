// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/command.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "app/command_line.hpp"
#include "app/run_folder.hpp"
#include "bench/accuracy.hpp"
#include "bench/kernel.hpp"
#include "bench/machine.hpp"
#include "bench/options.hpp"
#include "bench/report.hpp"
#include "bench/stability.hpp"
#include "core/error.hpp"
#include "core/nearest_name.hpp"

namespace drogue::bench {

namespace {

namespace fs = std::filesystem;

struct Family {
  std::string name, title;
  std::function<Report(const Options&)> measure;
  std::vector<std::string> parts = {};  ///< that --only may name
};

const std::vector<Family> families{{"kernel", "Fluid kernel", measure_kernel},
                                   {"accuracy", "Run time against error", measure_accuracy, accuracy_parts()},
                                   {"stability", "Stability", measure_stability, stability_parts()}};

const Family& family_of(const std::string& name) {
  const auto family = std::ranges::find(families, name, &Family::name);
  if (family != families.end()) return *family;
  std::vector<std::string> names;
  for (const Family& f : families) names.push_back(f.name);
  throw InputError(
      fmt::format("{} is no benchmark (there are {}){}", name, fmt::join(names, ", "), did_you_mean(name, names)));
}

void refuse_unknown_parts(const std::vector<Family>& wanted, const std::vector<std::string>& only) {
  std::vector<std::string> parts;
  for (const Family& family : wanted) parts.insert(parts.end(), family.parts.begin(), family.parts.end());
  for (const std::string& name : only) {
    if (std::ranges::find(parts, name) != parts.end()) continue;
    throw InputError(fmt::format("--only {} names no part (there are {}){}", name, fmt::join(parts, ", "),
                                 did_you_mean(name, parts)));
  }
}

}  // namespace

int run_command(std::vector<std::string> arguments) {
  CLI::App app("Measures speed, run time against error, and stability; writes tables (CSV, Markdown) and figures.",
               "drogue bench");
  Options options;
  std::vector<std::string> names;
  std::optional<int> threads;
  app.add_option("FAMILY", names, "kernel, accuracy, stability (default: all)");
  app.add_option("-o,--output", options.folder, "folder of tables and figures (default: runs/bench)");
  app.add_option("--only", options.only, "a part of a family, e.g. a flow; may be repeated")->allow_extra_args(false);
  app::add_threads(app, threads);
  app.add_flag("--quick", options.quick, "seconds instead of minutes: to see that it works");
  if (const auto exit_code = app::parse(app, std::move(arguments))) return *exit_code;

  std::vector<Family> wanted = names.empty() ? families : std::vector<Family>{};
  for (const std::string& name : names) wanted.push_back(family_of(name));
  refuse_unknown_parts(wanted, options.only);
  if (threads) omp_set_num_threads(*threads);
  std::error_code error;
  fs::create_directories(options.folder, error);
  if (error) throw InputError(fmt::format("{} cannot be made: {}", options.folder.string(), error.message()));
  bool drawn = true;
  for (const Family& family : wanted) {
    const Report report = family.measure(options);
    const std::string page = fmt::format("## {}\n\n{}\n\n{}", family.title, describe_machine(), report.text);
    app::write_text(options.folder / (family.name + ".md"), page);
    fmt::print("\n{}", page);
    drawn = drawn && report.drawn;
  }
  fmt::print("\nTables and figures are in {}\n", options.folder.string());
  if (!drawn) fmt::print(stderr, "{}\n", io::no_gnuplot);
  return 0;
}

}  // namespace drogue::bench
