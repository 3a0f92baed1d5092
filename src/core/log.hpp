// SPDX-License-Identifier: GPL-3.0-or-later
// What a run tells its user: plain lines on the terminal, the same lines with the time of day in a file.
#pragma once

#include <spdlog/logger.h>

#include <filesystem>
#include <utility>

namespace drogue {

class Log {
 public:
  /// A quiet log shows warnings only; its file, if there is one, still holds everything.
  explicit Log(bool quiet = false);

  /// From now on lines go to this file as well, which is replaced unless `append`. Throws InputError if it cannot be
  /// written.
  void open(const std::filesystem::path& file, bool append = false);

  template <class... T>
  void info(fmt::format_string<T...> text, T&&... values) {
    logger_.info(text, std::forward<T>(values)...);
  }
  template <class... T>
  void warn(fmt::format_string<T...> text, T&&... values) {
    logger_.warn(text, std::forward<T>(values)...);
  }

 private:
  spdlog::logger logger_;
};

}  // namespace drogue
