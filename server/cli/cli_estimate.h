#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace slipway::server {

// The subcommand "estimate" with its own "wheel", "plates" and "drives"; each puts itself into `run` when it
// is called.
void add_estimate_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
