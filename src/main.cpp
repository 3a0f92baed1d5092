// SPDX-License-Identifier: GPL-3.0-or-later
// Exit codes: 0 done, 1 something unforeseen, 2 a mistake in the input, 3 the solution diverged, 130 interrupted.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string_view>

#include "app/command_line.hpp"
#include "bench/command.hpp"
#include "core/error.hpp"

int main(int count, char** words) {
  try {
    if (count > 1 && std::string_view(words[1]) == "bench")
      return drogue::bench::run_command({words + 2, words + count});
    return drogue::app::run_command(words[0], {words + 1, words + count});
  } catch (const drogue::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  } catch (const drogue::Diverged& error) {
    fmt::print(stderr, "the run diverged: {}\n", error.what());
    return 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "unexpected: {}\n", error.what());
    return 1;
  }
}
