// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run.hpp"

#include <fmt/format.h>
#include <omp.h>
#include <sys/resource.h>

#include <exception>
#include <stdexcept>

#include "app/case_changes.hpp"
#include "app/case_reader.hpp"
#include "app/checkpoints.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "app/recorder.hpp"
#include "app/run_folder.hpp"
#include "app/simulation.hpp"
#include "app/summary.hpp"
#include "app/version.hpp"
#include "core/error.hpp"
#include "core/log.hpp"

namespace drogue::app {

namespace {

namespace fs = std::filesystem;

std::int64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

void announce(const Case& c, const Simulation& simulation, const fs::path& folder, Log& log) {
  log.info("{}", c.title.empty() ? c.name : c.title);
  for (const auto& body : simulation.bodies()) {
    if (!body->solver().empty()) log.info("structure of {}: {}", body->description.name, body->solver());
  }
  if (!simulation.fluid()) {
    log.info("structures alone, steps of {:.4g} s, {} threads; writing to {}", simulation.time_step(),
             omp_get_max_threads(), folder.string());
    return;
  }
  const amr::Forest& forest = simulation.fluid()->forest();
  std::int64_t cells = 0;
  for (int level = 0; level < forest.levels(); ++level) cells += forest.cells(level);
  log.info("{:.2f} million cells on {} levels, steps of {:.4g} s, {} threads; writing to {}",
           1e-6 * static_cast<double>(cells), forest.levels(), simulation.time_step(), omp_get_max_threads(),
           folder.string());
}

/// An empty folder for a new run, or that of the run that is continued, as it was at its last checkpoint.
void open_run(bool resume, const Case& c, const fs::path& folder, Simulation& simulation, Recorder& recorder,
              Checkpoints& checkpoints, Log& log) {
  if (!resume) clear_run_folder(folder);
  log.open(folder / "log.txt", resume);
  if (resume) checkpoints.restore();
  write_text(folder / "case.resolved.toml", c.resolved);
  fs::remove(folder / "summary.json");
  announce(c, simulation, folder, log);
  if (resume) {
    recorder.resume(simulation);
  } else {
    recorder.start(simulation);
  }
}

/// Steps until `end` [s]; false if interrupted.
bool step_until(double end, Simulation& simulation, Recorder& recorder, Checkpoints& checkpoints, Progress& progress,
                const Interrupt& interrupt) {
  const double last = end - 1e-6 * simulation.time_step();
  const auto write_checkpoint = [&] {
    progress.clear();
    checkpoints.write();
  };
  while (simulation.time() < last && !interrupt.requested()) {
    simulation.step();
    recorder.record(simulation, simulation.time() >= last);
    if (checkpoints.due()) write_checkpoint();
    progress.update(simulation.time(), recorder.mlups(), recorder.c_d());
  }
  write_checkpoint();
  return simulation.time() >= last;
}

Summary summarise_run(const Case& c, const Simulation& simulation, const Recorder& recorder, double output_seconds,
                      double wall_seconds) {
  Summary s;
  s.case_name = c.name;
  s.title = c.title;
  s.fluid = c.solver;
  s.version = version;
  s.threads = omp_get_max_threads();
  s.t_end = simulation.time();
  s.wall_seconds = wall_seconds;
  const double stepping = simulation.step_seconds(), coupling = simulation.coupling_seconds();
  if (const fluid::FluidSolver* fluid = simulation.fluid()) {
    s.cell_updates = fluid->statistics().cell_updates;
    const amr::Forest& forest = fluid->forest();
    for (int level = 0; level < forest.levels(); ++level) s.cells_per_level.push_back(forest.cells(level));
  }
  s.mlups = stepping > 0.0 ? 1e-6 * static_cast<double>(s.cell_updates) / stepping : 0.0;
  s.peak_rss_bytes = peak_rss_bytes();
  const double structure = simulation.structure_seconds();
  s.time_share = {{"fluid", (stepping - coupling) / wall_seconds},
                  {"ib", (coupling - structure) / wall_seconds},
                  {"structure", structure / wall_seconds},
                  {"io", output_seconds / wall_seconds},
                  {"other", (wall_seconds - stepping - output_seconds) / wall_seconds}};
  for (const auto& body : simulation.bodies()) {
    const std::string& name = body->description.name;
    if (!body->solver().empty()) s.structure.emplace_back(name, body->solver());
    if (!body->warning().empty()) s.warnings.push_back(fmt::format("body {}: {}", name, body->warning()));
  }
  s.results = summarise(recorder.trace(), c);
  s.references = compare(s.results, c.references);
  return s;
}

}  // namespace

int run_case(const RunOptions& options) {
  Elapsed wall;

  // 1. What is asked for, and whether it may be written.
  const Case c = read_case(options.path, options.overrides);
  const fs::path folder = options.folder.empty() ? fs::path("runs") / c.name : options.folder;
  const double end = options.until.value_or(c.end);
  if (options.resume) {
    expect_same_case(folder, c.resolved);
  } else {
    refuse_other_run(folder, options.force);
  }

  // 2. The machine: signals before threads, which inherit them.
  const Interrupt interrupt;
  if (options.threads) omp_set_num_threads(*options.threads);

  // 3. Grid, fluid and bodies.
  Simulation simulation(c, folder);

  // 4. The folder of the run.
  const FolderLock lock(folder);
  Log log(options.quiet);
  Recorder recorder(c, simulation, folder);
  Checkpoints checkpoints(folder, c.output.checkpoint, simulation, recorder, wall, log);
  open_run(options.resume, c, folder, simulation, recorder, checkpoints, log);
  if (simulation.time() >= end) {
    log.info("the run has reached {:.6g} s; --until goes on beyond it", simulation.time());
  }

  // 5. Time.
  Ending ending = Ending::failed;
  std::string message;
  std::exception_ptr failure;
  try {
    Progress progress(simulation.time(), end, options.quiet);
    const bool arrived = step_until(end, simulation, recorder, checkpoints, progress, interrupt);
    if (arrived) recorder.finish(simulation);
    ending = arrived ? Ending::finished : Ending::interrupted;
  } catch (const Diverged& error) {
    ending = Ending::diverged;
    message = error.what() + checkpoints.hint();
    failure = std::make_exception_ptr(Diverged(message));
  } catch (const InputError& error) {
    message = error.what();
    failure = std::current_exception();
  } catch (const std::exception& error) {
    message = error.what() + checkpoints.hint();
    failure = std::make_exception_ptr(std::runtime_error(message));
  }

  // 6. What came of it.
  Summary summary = summarise_run(c, simulation, recorder, recorder.seconds() + checkpoints.seconds(), wall.seconds());
  summary.ending = ending;
  summary.message = message;
  write_summary(summary, folder / "summary.json");
  print_summary(summary, log);
  for (const std::string& warning : summary.warnings) log.warn("{}", warning);
  if (ending == Ending::interrupted) log.warn("interrupted at {:.6g} s{}", simulation.time(), checkpoints.hint());
  if (failure) std::rethrow_exception(failure);
  return ending == Ending::interrupted ? 130 : 0;
}

}  // namespace drogue::app
