#include <csignal>
#include <exception>
#include <iostream>

#include "server/cli/cli_app.h"
#include "server/cli/commands.h"

// The one place where broken promises are caught outside the HTTP server.
int main(int argc, char** argv) {
  // Ctrl-C gives up a question in progress; serve() takes the signals over for itself.
  std::signal(SIGINT, [](int) { slipway::server::interrupt(); });
  try {
    return slipway::server::run_command_line(argc, argv);
  } catch (const std::exception& broken) {
    std::cerr << "internal error: " << broken.what() << "\n";
    return 70;
  }
}
