#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace slipway::server {

// Adds the subcommand compare-plans; `run` then runs it where it is given. The exit status: 0 a comparison, 1
// none, 2 answers that can't be compared.
void add_compare_answers_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
