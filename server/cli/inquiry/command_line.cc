#include "server/cli/inquiry/command_line.h"

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <exception>
#include <iostream>
#include <string>

#include "server/cli/inquiry/command_parts.h"
#include "server/cli/terminal/interruption.h"
#include "server/cli/terminal/printable_output.h"

namespace slipway::server {
namespace {

// CLI11 reads "nan" and "inf" as numbers; here they never are: every option that is a number refuses them.
void refuse_what_is_not_finite(CLI::App& app) {
  const CLI::Validator finite(
      [](std::string& text) -> std::string {
        double number = 0.0;
        return CLI::detail::lexical_cast(text, number) && !std::isfinite(number)
                   ? text + " is not a finite number"
                   : "";
      },
      "");
  for (CLI::Option* const option : app.get_options())
    if (option->get_type_name().find("FLOAT") != std::string::npos) option->check(finite);
  for (CLI::App* const command : app.get_subcommands({})) refuse_what_is_not_finite(*command);
}

// Where the caller closed standard output, a file that is opened next would take its place, and what is
// printed would land in that file. Nothing can be written to what takes the place here.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) static_cast<void>(open("/dev/null", O_RDONLY));
}

}  // namespace

int parse_and_run(CLI::App& app, const std::function<int()>& run, int argc, char** argv) {
  refuse_what_is_not_finite(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error);
    return status == 0 ? 0 : 2;
  }
  return run();
}

int run_program(int argc, char** argv, int (*command_line)(int argc, char** argv)) {
  // Ctrl-C gives up a question in progress; serve() takes the signals over for itself.
  std::signal(SIGINT, [](int) { interrupt(); });
  occupy_closed_streams();
  // Names out of files and requests end in what is printed: none of them commands the terminal.
  PrintableOutput answers(std::cout);
  PrintableOutput messages(std::cerr);
  try {
    const int status = command_line(argc, argv);
    return output_has_gone_out() ? status : std::max(status, 1);
  } catch (const std::exception& broken) {
    std::cerr << "internal error: " << broken.what() << "\n";
    return 70;
  }
}

}  // namespace slipway::server
