#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace slipway::server {

struct DiagnoseCommand {
  std::string data;
  std::string campaign;              // folder of a "drive-campaign/1"
  std::string reference;             // folder of another, of the same rover, taken as healthy; empty: none
  std::vector<std::string> without;  // effects that are not looked for
  std::uint64_t seed = 1;
  int threads = 0;            // 0: as many as the machine has
  std::string report, model;  // folders; empty: none
  bool json = false;
};

// The exit status: 0 a diagnosis, whatever its verdict, 1 none, 2 input that can't be read.
int diagnose(const DiagnoseCommand& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_diagnose_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
