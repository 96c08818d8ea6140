#pragma once

#include <csignal>
#include <initializer_list>

namespace slipway::server {

// Blocks these signals, so that every thread started later leaves them to sigwait() or a signalfd.
inline sigset_t block_signals(std::initializer_list<int> those) {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : those) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  return signals;
}

}  // namespace slipway::server
