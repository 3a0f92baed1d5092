// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "app/inspect.hpp"
#include "app/plot.hpp"
#include "app/run.hpp"
#include "app/section.hpp"
#include "app/version.hpp"
#include "core/error.hpp"
#include "core/nearest_name.hpp"

namespace drogue::app {

namespace {

namespace fs = std::filesystem;

/// Becomes drogue-render, a program of its own because it needs VTK; returns only by throwing.
[[noreturn]] void become_render(std::vector<std::string> arguments) {
  const fs::path renderer = fs::read_symlink("/proc/self/exe").parent_path() / "drogue-render";
  if (!fs::exists(renderer)) {
    throw InputError(
        fmt::format("{} is not built; ./drogue render builds it on first use, or configure with "
                    "-DDROGUE_RENDER=ON",
                    renderer.filename().string()));
  }
  std::string name = renderer.string();
  std::vector<char*> words{name.data()};
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  execv(name.c_str(), words.data());
  throw InputError(fmt::format("{} cannot be started", name));
}

CLI::Validator number_within(const Range& range) {
  const auto refuse = [range](const std::string& text) {
    double value = 0.0;
    const bool fits = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && range.holds(value);
    return fits ? "" : fmt::format("\"{}\" is no number {}", text, range.text());
  };
  return {refuse, ""};
}

void refuse_unknown_command(const CLI::App& app, const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments.front().starts_with("-")) return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  if (std::ranges::find(names, arguments.front()) != names.end()) return;
  throw InputError(fmt::format("{} is not a command{}", arguments.front(), did_you_mean(arguments.front(), names)));
}

void add_case(CLI::App* command, fs::path& path, std::vector<std::string>& overrides) {
  command->add_option("CASE", path, "case folder, or case file")->required();
  command->add_option("--set", overrides, "key=value: override a key of the case; may be repeated")
      ->allow_extra_args(false);
}

}  // namespace

std::optional<int> parse(CLI::App& app, std::vector<std::string> arguments) {
  std::ranges::reverse(arguments);  // as CLI11 wants them
  try {
    app.parse(arguments);
  } catch (const CLI::Success& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    throw InputError(fmt::format("{}; see {} --help", error.what(), app.get_name()));
  }
  return std::nullopt;
}

void add_threads(CLI::App& command, std::optional<int>& threads) {
  // the run-time library of OpenMP crashes on very many
  command.add_option("--threads", threads, "number of threads (default: all)")
      ->check(number_within({.min = 1, .max = 1024}));
}

int run_command(const std::string& program, std::vector<std::string> arguments) {
  if (!arguments.empty() && arguments.front() == "render") {
    become_render({arguments.begin() + 1, arguments.end()});
  }
  CLI::App app("Drogue simulates the inflation of parachutes.", fs::path(program).filename().string());
  app.set_version_flag("--version", std::string(version));
  app.require_subcommand(1);
  app.failure_message([](const CLI::App*, const CLI::Error& error) { return std::string(error.what()); });

  RunOptions run;
  CLI::App* run_command = app.add_subcommand("run", "run a case");
  add_case(run_command, run.path, run.overrides);
  run_command->add_option("-o,--output", run.folder, "folder of the run (default: runs/NAME)");
  add_threads(*run_command, run.threads);
  run_command->add_option("--until", run.until, "stop at this time [s]")->check(number_within(positive));
  CLI::Option* force = run_command->add_flag("--force", run.force, "replace a run that is already there");
  run_command->add_flag("--continue", run.resume, "go on with the run in that folder, from its last checkpoint")
      ->excludes(force);
  run_command->add_flag("--quiet", run.quiet, "show warnings and errors only");

  fs::path path;
  std::vector<std::string> overrides;
  CLI::App* check_command = app.add_subcommand("check", "read and validate a case, and show what follows from it");
  add_case(check_command, path, overrides);

  std::string key;
  CLI::App* params_command = app.add_subcommand("params", "list the keys of a case, with units and defaults");
  params_command->add_option("KEY", key, "a table (fluid) or a key (fluid.density)");

  fs::path picture;
  CLI::App* plot_command = app.add_subcommand("plot", "draw what a run gave, against the references of its case");
  plot_command->add_option("RUN", path, "folder of the run")->required();
  plot_command->add_option("-o,--output", picture, "the picture (default: RUN/plot.png)");

  // its own command line, in a layer above
  app.add_subcommand("bench", "speed, run time against error, stability");
  app.add_subcommand("info", "version, compiler, processor, libraries");
  app.add_subcommand("render", "pictures of a run (drogue-render)");

  refuse_unknown_command(app, arguments);
  if (const auto exit_code = parse(app, std::move(arguments))) return *exit_code;

  if (*run_command) return run_case(run);
  std::string text = build_info();
  if (*check_command) text = check_report(path, overrides);
  if (*plot_command) text = plot_run(path, picture);
  if (*params_command) text = list_keys(key);
  fmt::print("{}", text);
  return 0;
}

}  // namespace drogue::app
