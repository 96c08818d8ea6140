#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/cli/inquiry/ask_options.h"

namespace CLI {
class App;
}

namespace slipway::server {

// A soil from tests or drives.
struct EstimateCommand {
  enum class From { kWheel, kPlates, kDrives };
  AskOptions ask;
  From from = From::kWheel;
  std::vector<std::string> files;  // CSVs, or the folder of a "drive-campaign/1"
  std::string rover, wheel;
  // "unknown_ground", and "LABEL=unknown_ground" of a soil that tests name.
  std::vector<std::string> soils;
  // "0.058" of all wheels, "0.058@LABEL" of one that tests name; of grousers "height_m,count".
  std::vector<std::string> radii, widths, grousers;
  std::optional<double> motor_temp_c;
  std::vector<std::string> effects, set;  // "smooth_rim@LABEL:friction_share=0.9", "c1@LABEL=0.4"
  std::string slip_radius = "rim";
  double gravity_m_s2 = 3.71, speed_m_s = 0.04;
  std::string slip_definition = "forward";
  std::vector<std::string> free, channels, bounds;  // bounds: "n=0.5:1.5"
  bool merge_stiffness = false, no_profile = false;
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
