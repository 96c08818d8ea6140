#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dem/grid_geometry.h"
#include "server/cli/inquiry/ask_options.h"
#include "server/cli/inquiry/drive_options.h"

namespace CLI {
class App;
}

namespace slipway::server {

struct MapOptions {
  AskOptions ask;
  DriveOptions drive;
  std::string kind;
  std::optional<double> heading_deg, distance_m;
  std::optional<dem::Extent> extent;
  std::string unknown;  // "nodata" or "belief"; empty: belief where --unknown-soil is given
  std::optional<PlaceOption> to, from;
  std::optional<double> budget_j, budget_sols, hours_per_sol;
  std::vector<std::string> weights;    // "NAME=VALUE"
  double every_m = 5.0, base_m = 0.0;  // of contours
  bool lonlat = false;
  bool resume = false;
  int threads = 0;
  std::string out;
};

// The exit status: 0 written, 1 the work failed or was given up, 2 options or files with faults.
int map(const MapOptions& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_map_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
