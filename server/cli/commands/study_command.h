#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace slipway::server {

// Adds the subcommands that slipway-study does: `run` hands the command line on to it. It stands beside this
// program where the study was built or installed; not_found says so where it does not.
void add_study_commands(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
