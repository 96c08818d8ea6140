#pragma once

#include <csignal>

namespace slipway::server {

// Blocks the signals that end the program, so that every thread started later leaves them to sigwait() or a
// signalfd.
inline sigset_t block_ending_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  return signals;
}

}  // namespace slipway::server
