#include "server/cli/terminal/interruption.h"

#include <atomic>

namespace slipway::server {
namespace {

// What a signal handler may write to; the program's one signal has one flag.
std::atomic<bool> interrupted{false};

}  // namespace

void interrupt() {
  interrupted = true;
}

bool given_up() {
  return interrupted;
}

}  // namespace slipway::server
