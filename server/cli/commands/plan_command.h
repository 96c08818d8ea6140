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

struct PlanOptions {
  AskOptions ask;
  DriveOptions drive;
  std::string
      request;  // file with a whole request, "-" is standard input; the options below are then not used
  std::optional<PlaceOption> start, goal;
  std::vector<std::string> start_error;  // "heading_deg=2"
  std::vector<PlaceOption> via;
  std::optional<int> routes, verify;
  std::vector<std::string> planners;
  std::vector<std::string> weights;  // "slip=8"
  std::optional<std::string> rank_by;
  std::optional<double> tail;
  std::string commands;  // file for a route's commands; empty: none
  int route = 1;         // whose
  std::string report;    // of a sol: a file for its page; empty: none
  bool compare = false;  // with the plan of the model that was corrected
};

// The exit status: 0 an answer (also "no safe route"), 1 no answer, 2 a question that can't be asked. The
// answer goes to standard output, problems and progress to standard error.
int plan(const PlanOptions& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_plan_command(CLI::App& app, std::function<int()>& run);
void add_sol_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
