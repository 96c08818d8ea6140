#pragma once

#include <chrono>
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

// An option in minutes as what a clock counts.
inline std::chrono::milliseconds milliseconds_of(double minutes) {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
      std::chrono::duration<double, std::ratio<60>>(minutes));
}

}  // namespace slipway::server
