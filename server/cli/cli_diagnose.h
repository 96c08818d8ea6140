#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace slipway::server {

// The subcommand "diagnose"; it puts itself into `run` when it is called.
void add_diagnose_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
