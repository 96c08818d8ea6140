#include <CLI/CLI.hpp>
#include <memory>

#include "server/cli/data_option.h"
#include "server/cli/validate_command.h"

namespace slipway::server {

void add_validate_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<ValidateOptions>();
  CLI::App* command =
      app.add_subcommand("validate", "compare with published and measured data, and say how far off");
  add_data_option(*command, options->data, "rovers, soils, terrains and validation data");
  CLI::Option* only =
      command->add_option("--only", options->only, "names of comparisons, see --list; all where not given");
  command->add_option("--plots", options->plots, "write one SVG per comparison into this folder");
  CLI::Option* check = command->add_option("--check", options->check,
                                           "also fail where this page does not hold what is printed");
  CLI::Option* write = command->add_option("--write", options->write, "put what is printed into this page");
  check->excludes(write)->excludes(only);
  write->excludes(only);
  command->add_flag("--json", options->json, "print the whole document, for machines");
  command->add_flag("--list", options->list, "what comparisons there are");
  command->footer(
      "Example: every comparison, with its pictures\n"
      "  slipway validate --plots plots\n"
      "Exit status: 0 every stated band holds, 1 one does not.");
  command->callback([options, &run] { run = [options] { return validate(*options); }; });
}

}  // namespace slipway::server
