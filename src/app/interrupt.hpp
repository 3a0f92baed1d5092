// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl-C and a polite kill, taken between two steps.
#pragma once

#include <csignal>

namespace drogue::app {

/// Holds SIGINT and SIGTERM back while it lives. Threads inherit that, so it is made before there are any.
class Interrupt {
 public:
  Interrupt() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  }
  /// Signals that arrived are taken, so that the process ends in its own way.
  ~Interrupt() {
    const timespec at_once{};
    while (sigtimedwait(&signals_, nullptr, &at_once) > 0) {
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool requested() const {
    sigset_t pending;
    sigpending(&pending);
    return sigismember(&pending, SIGINT) == 1 || sigismember(&pending, SIGTERM) == 1;
  }

 private:
  sigset_t signals_, before_;
};

}  // namespace drogue::app
