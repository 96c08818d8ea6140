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

struct CurrentMapCommand {
  AskOptions ask;
  std::optional<int> figure;
  std::string rover = "zhurong-class", soil = "jlu_mars_2_dense";
  std::string x = "slip", y;  // "k_s" or "k_s=60e3:600e3:60e3"; y may be empty
  double slip = 0.1, gravity_m_s2 = 9.81;
  std::optional<double> load_n;
  std::string model = "literal";  // or "balanced"
  std::string csv, plot;          // files; empty: none
};

struct CurrentInvertCommand {
  AskOptions ask;
  std::string rover = "zhurong-class", wheel, soil = "jlu_mars_2_dense";
  double current_a = 0.0, gravity_m_s2 = 3.71, max_slip = 0.4;
  std::optional<double> load_n, speed_m_s, motor_temp_c;
  std::vector<std::string> effects;
  int draws = 200;
  std::uint64_t seed = 1;
};

// The exit status: 0 an answer (also "no safe route"), 1 no answer, 2 a question that can't be asked. The
// answer goes to standard output, problems and progress to standard error.
int current_map(const CurrentMapCommand& options);
int current_invert(const CurrentInvertCommand& options);

// Adds the subcommand with its own subcommands map and invert.
void add_current_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
