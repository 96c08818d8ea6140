#pragma once

#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace slipway::server {

struct ImportCommand {
  std::string data;
  std::string mapping;  // "drive-import/1"
  std::string out;      // folder of the campaign; empty: nothing is written
  std::string plot;     // file for a picture; empty: none
};

// The exit status: 0 a campaign that can be read, 1 it could not be written, 2 faults.
int import(const ImportCommand& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_import_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
