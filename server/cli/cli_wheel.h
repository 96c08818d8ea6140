#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace slipway::server {

// The subcommands of a single wheel, "wheel" and "current"; the one that is called puts itself into `run`.
void add_wheel_command(CLI::App& app, std::function<int()>& run);
void add_current_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
