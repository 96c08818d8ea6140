#pragma once

#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace slipway::server {

struct DataCheckOptions {
  std::string data;  // empty: found as by every command
  bool json = false;
};

// Reads every rover, soil, set of rules and terrain of the data folder, and a piece of each terrain's maps.
// The exit status: 0 all are good, 2 some are left out and the others used, or there is no usable folder.
int check_data(const DataCheckOptions& options);

// Adds `slipway data check`; `run` then runs it where it is given.
void add_data_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
