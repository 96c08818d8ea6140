#pragma once

#include <functional>

namespace CLI {
class App;
}

// What slipway and slipway-study do alike with their command lines.
namespace slipway::server {

// Reads the command line as `app` has it and runs what the subcommand left in `run`. Options that are numbers
// refuse nan and inf. The exit status: the subcommand's, 2 where the command line can't be read.
int parse_and_run(CLI::App& app, const std::function<int()>& run, int argc, char** argv);

// What main() does: `command_line` with closed streams occupied, Ctrl-C heard, printed names kept from
// commanding the terminal, and broken promises caught (70).
int run_program(int argc, char** argv, int (*command_line)(int argc, char** argv));

}  // namespace slipway::server
