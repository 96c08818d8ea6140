#pragma once

#include <functional>
#include <optional>
#include <string>

#include "server/cli/inquiry/ask_options.h"
#include "server/cli/inquiry/drive_options.h"

namespace CLI {
class App;
}

namespace slipway::server {

struct TerrainOptions {
  AskOptions ask;
  std::string name = "gale";
  std::optional<PlaceOption> at;
  bool lonlat = false;  // `at` is longitude, latitude
};

// The exit status: 0 an answer (also "no safe route"), 1 no answer, 2 a question that can't be asked. The
// answer goes to standard output, problems and progress to standard error.
int terrain(const TerrainOptions& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_terrain_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
