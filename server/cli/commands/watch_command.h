#pragma once

#include <functional>
#include <string>

#include "server/cli/commands/diagnose_command.h"

namespace CLI {
class App;
}

namespace slipway::server {

// The drives are in their order, or are a table of measured steps (*.csv); without a reference the first of
// them are taken as healthy.
struct WatchCommand : DriveQuestion {
  std::string rover = "msl-class";  // that made the steps
  int learn = 12;                   // of the campaign's drives where there is no reference
  double alpha = 0.01;
  bool diagnose = true;
};

// The exit status: 0 nothing has changed, 6 something has, 1 no answer, 2 input that can't be read.
int watch(const WatchCommand& options);
// The same of a table of measured steps ("slip-steps/1").
int watch_steps(const WatchCommand& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_watch_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
