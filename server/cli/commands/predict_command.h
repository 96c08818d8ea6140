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

struct PredictOptions {
  AskOptions ask;
  DriveOptions drive;
  std::string request;
  std::vector<PlaceOption> path;
  bool backwards = false;
  std::optional<double> crab_deg;
  std::string level;  // of fidelity; empty: the request's default
  std::string plot;   // file for the dynamic drive's time history; empty: none
};

// The exit status: 0 an answer (also "no safe route"), 1 no answer, 2 a question that can't be asked. The
// answer goes to standard output, problems and progress to standard error.
int predict(const PredictOptions& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_predict_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
