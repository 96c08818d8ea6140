#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/cli/inquiry/ask_options.h"

namespace CLI {
class App;
}

namespace slipway::server {

// A single wheel on a rig.
struct WheelOptions {
  AskOptions ask;
  std::string rover = "mer-class", wheel, soil = "unknown_ground";
  std::vector<std::string> sweeps;  // "slip=0:0.9:0.1", "load_n=20,50,80"
  std::vector<std::string> set;     // "soil.n=1.1"
  std::optional<double> load_n, sinkage_m, slip, slip_angle_deg, gravity_m_s2, radius_m, width_m, speed_m_s;
  std::string slip_definition, speed_of;  // empty: the request's default
  std::optional<double> slope_deg;
  std::string slip_radius;  // rim, shear or tip
  std::string rows;         // CSV of rows with their own parameters
  std::string grousers;     // "height_m,count"
  std::optional<double> motor_temp_c;
  bool in_a_track = false, whole_rover = false;
  std::vector<std::string> effects;
  std::string csv, plot;  // files; empty: none
};

// The exit status: 0 an answer (also "no safe route"), 1 no answer, 2 a question that can't be asked. The
// answer goes to standard output, problems and progress to standard error.
int wheel(const WheelOptions& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_wheel_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
