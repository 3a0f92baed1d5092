// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/log.hpp"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <memory>

#include "core/error.hpp"

namespace drogue {

Log::Log(bool quiet) : logger_("drogue") {
  auto terminal = std::make_shared<spdlog::sinks::stdout_sink_st>();
  terminal->set_pattern("%v");
  terminal->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
  logger_.sinks().push_back(terminal);
  logger_.flush_on(spdlog::level::info);
}

void Log::open(const std::filesystem::path& file, bool append) {
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_st>(file.string(), !append);
    sink->set_pattern("%Y-%m-%d %H:%M:%S  %v");
    logger_.sinks().push_back(sink);
  } catch (const spdlog::spdlog_ex&) {
    throw InputError(fmt::format("{} cannot be written", file.string()));
  }
}

}  // namespace drogue
