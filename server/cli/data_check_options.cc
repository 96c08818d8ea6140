#include <CLI/CLI.hpp>
#include <memory>

#include "server/cli/data_check_command.h"
#include "server/cli/data_option.h"

namespace slipway::server {

void add_data_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<DataCheckOptions>();
  CLI::App* const data = app.add_subcommand("data", "the folder of rovers, soils, rules and terrains");
  data->require_subcommand(1);
  CLI::App* const check = data->add_subcommand(
      "check", "read every file of the data folder: those with faults are listed, and no command uses them");
  add_data_option(*check, options->data, "rovers, soils, rules and terrains");
  check->add_flag("--json", options->json, "print JSON (data-check/1)");
  check->footer(
      "Example:\n  slipway data check --data my_data\nExit status: 0 all are good, 2 some are left out");
  check->callback([options, &run] { run = [options] { return check_data(*options); }; });
}

}  // namespace slipway::server
