#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <iostream>

#include "server/cli/cli_app.h"
#include "server/cli/command_parts.h"
#include "server/cli/terminal/interruption.h"
#include "server/cli/terminal/printable_output.h"

namespace {

// Where the caller closed standard output, a file that is opened next would take its place, and what is
// printed would land in that file. Nothing can be written to what takes the place here.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) static_cast<void>(open("/dev/null", O_RDONLY));
}

}  // namespace

// The one place where broken promises are caught outside the HTTP server.
int main(int argc, char** argv) {
  // Ctrl-C gives up a question in progress; serve() takes the signals over for itself.
  std::signal(SIGINT, [](int) { slipway::server::interrupt(); });
  occupy_closed_streams();
  // Names out of files and requests end in what is printed: none of them commands the terminal.
  slipway::server::PrintableOutput answers(std::cout);
  slipway::server::PrintableOutput messages(std::cerr);
  try {
    const int status = slipway::server::run_command_line(argc, argv);
    return slipway::server::output_has_gone_out() ? status : std::max(status, 1);
  } catch (const std::exception& broken) {
    std::cerr << "internal error: " << broken.what() << "\n";
    return 70;
  }
}
