#include "server/cli/terminal/terminal_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "server/cli/terminal/interruption.h"
#include "server/cli/terminal/printable_output.h"

namespace slipway::server {

TerminalProgress::TerminalProgress() : terminal_(isatty(STDERR_FILENO) != 0) {}

TerminalProgress::~TerminalProgress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void TerminalProgress::report(std::string_view stage, double fraction) {
  if (!terminal_) return;
  shown_ = true;
  std::fputs(fmt::format("\r\033[K{:3.0f} % {}", 100.0 * fraction, printable(stage)).c_str(), stderr);
  std::fflush(stderr);
}

bool TerminalProgress::cancelled() const {
  return given_up();
}

}  // namespace slipway::server
