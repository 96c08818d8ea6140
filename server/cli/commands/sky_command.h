#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/cli/inquiry/drive_options.h"

namespace CLI {
class App;
}

namespace slipway::server {

// slipway sky: time, sun, Earth and the ground's horizon over a place.
struct SkyOptions {
  std::optional<std::string> at;  // of UTC; without it: now
  std::string lonlat;             // "137.4,-4.6", east and planetocentric; empty: of the terrain's place
  std::string terrain;
  std::optional<PlaceOption> place;  // map metres
  std::vector<std::string> sky;      // kernels; empty: by formulas, on Mars alone
  std::string body = "Mars";         // of lonlat
  std::string table;                 // a file for the moments of kernels, from `at` to `until`
  std::optional<std::string> until;  // of UTC
  bool horizon = false;              // print it
  std::string horizon_map;           // a file to write
  int every = 0;                     // cells of the terrain to one of the map; 0: so that it has 2048 at most
  int directions = 72;
  double eye_m = 1.0;
  bool json = false;
  std::string data;
};

void add_sky_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
