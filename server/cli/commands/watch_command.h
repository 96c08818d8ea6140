#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace slipway::server {

struct WatchCommand {
  std::string data;
  // Folder of a "drive-campaign/1", its drives in their order, or a table of measured steps (*.csv).
  std::string campaign;
  std::string rover = "msl-class";   // that made the steps
  std::string reference;             // folder of healthy drives; empty: the campaign's first ones
  std::vector<std::string> without;  // effects that are not looked for
  int learn = 12;                    // of the campaign's drives where there is no reference
  double alpha = 0.01;
  std::uint64_t seed = 1;
  int threads = 0;     // 0: as many as the machine has
  std::string report;  // folder, or an HTML file; empty: none
  bool diagnose = true, json = false;
};

// The exit status: 0 nothing has changed, 6 something has, 1 no answer, 2 input that can't be read.
int watch(const WatchCommand& options);
// The same of a table of measured steps ("slip-steps/1").
int watch_steps(const WatchCommand& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_watch_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
