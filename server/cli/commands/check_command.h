#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/cli/inquiry/ask_options.h"
#include "server/cli/inquiry/drive_options.h"

namespace CLI {
class App;
}

namespace slipway::server {

struct CheckOptions {
  AskOptions ask;
  DriveOptions drive;
  std::vector<PlaceOption> path;
  std::optional<PlaceOption> start;
  std::vector<std::string> commands;                // "drive=5", "arc=4,6", "turn=-30"
  std::string commands_file;                        // as slipway plan writes it; empty: none
  bool names_terrain = false, names_rover = false;  // on the command line
  std::string rules;
  bool backwards = false;
  std::optional<double> crab_deg;
  std::string report;   // file for the page; empty: none
  std::string request;  // file with the whole request
};

// The exit status: of the verdict (see ExitStatus).
int check(const CheckOptions& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_check_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
