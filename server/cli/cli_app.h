#pragma once

namespace slipway::server {

// Parses the command line and runs what it asks; the process's exit status.
int run_command_line(int argc, char** argv);

}  // namespace slipway::server
