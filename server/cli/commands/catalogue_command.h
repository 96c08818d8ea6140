#pragma once

#include <functional>
#include <string>

#include "server/cli/inquiry/ask_options.h"

namespace CLI {
class App;
}

namespace slipway::server {

// What the service has: a table of rovers, soils or effects, and whether it answers. The exit status: 0 an
// answer, 1 none, 2 a question that can't be asked.
int rovers(const AskOptions& options);
int soils(const AskOptions& options);
// `name`: the effect whose parameters are explained; empty for the list of all effects.
int effects(const AskOptions& options, const std::string& name);
// Asks a running service, for which it needs its address.
int health(const AskOptions& options);

// Adds the four subcommands; `run` then runs the one that is given.
void add_catalogue_commands(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
