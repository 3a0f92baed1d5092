// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/checkpoints.hpp"

#include <fmt/format.h>

#include <ranges>

#include "core/error.hpp"
#include "io/checkpoint.hpp"

namespace drogue::app {

namespace fs = std::filesystem;

Checkpoints::Checkpoints(const fs::path& folder, double interval, Simulation& simulation, Recorder& recorder,
                         Elapsed& wall, Log& log)
    : folder_(folder), interval_(interval), simulation_(simulation), recorder_(recorder), wall_(wall), log_(log) {}

void Checkpoints::transfer_state(Archive& archive) {
  archive.transfer("number", next_);
  archive.transfer("simulation", simulation_);
  archive.transfer("recorder", recorder_);
  archive.transfer("time_spent", watch_);
}

void Checkpoints::write() {
  if (interval_ <= 0.0 || simulation_.time() == newest_time_) return;
  since_last_ = Elapsed();
  const Timed timed(watch_);
  try {
    io::CheckpointWriter out(io::checkpoint_path(folder_, next_));
    transfer_state(out);
    out.put_number("time", simulation_.time());
    out.put_number("wall_seconds", wall_.seconds());
    out.commit();
    io::prune_checkpoints(folder_);
    newest_time_ = simulation_.time();
    ++next_;
  } catch (const std::exception& error) {
    log_.warn("no checkpoint at {:.6g} s: {}", simulation_.time(), error.what());
  }
}

void Checkpoints::restore() {
  for (const fs::path& file : io::list_checkpoints(folder_) | std::views::reverse) {
    try {
      io::CheckpointReader in(file);
      transfer_state(in);
      wall_.add(in.number("wall_seconds"));
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& error) {
      log_.warn("a checkpoint is damaged, the one before is tried: {}", error.what());
      continue;
    }
    ++next_;
    newest_time_ = simulation_.time();
    log_.info("continuing from {} at {:.6g} s", file.string(), newest_time_);
    return;
  }
  throw InputError(
      fmt::format("{} holds no checkpoint that can be read; give --force to start again", folder_.string()));
}

std::string Checkpoints::hint() const {
  if (newest_time_ < 0.0) return "";
  return fmt::format("; {} keeps the state at {:.6g} s, for --continue",
                     io::checkpoint_path(folder_, next_ - 1).string(), newest_time_);
}

}  // namespace drogue::app
