#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/cli/ask_options.h"

namespace CLI {
class App;
}

namespace slipway::server {

// A soil from tests or drives.
struct EstimateCommand {
  enum class From { kWheel, kPlates, kDrives };
  AskOptions ask;
  From from = From::kWheel;
  std::string file;  // a CSV, or the folder of a "drive-campaign/1"
  std::string soil = "unknown_ground", rover, wheel;
  std::optional<double> radius_m, width_m, motor_temp_c;
  std::string grousers;  // "height_m,count"
  double gravity_m_s2 = 3.71, speed_m_s = 0.04;
  std::string slip_definition = "forward";
  std::vector<std::string> free, channels, bounds;  // bounds: "n=0.5:1.5"
  bool merge_stiffness = false;
  std::string priors = "wide", loss = "none";
  std::optional<double> loss_scale;
  double noise = 0.02;  // share of a reading
  std::uint64_t seed = 1;
  int threads = 0;             // of drives
  std::string soil_out, plot;  // files; empty: none
};

// The exit status: 0 an estimate, 1 none, 2 input that can't be read.
int estimate(const EstimateCommand& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_estimate_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
