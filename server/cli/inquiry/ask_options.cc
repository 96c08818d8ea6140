#include "server/cli/inquiry/ask_options.h"

#include <CLI/CLI.hpp>

#include "server/cli/inquiry/data_option.h"

namespace slipway::server {

void add_local_ask(CLI::App& command, AskOptions& ask) {
  add_data_option(command, ask.data, "rovers, soils and terrains");
  command.add_flag("--json", ask.json, "print the whole document, for machines");
}

void add_ask(CLI::App& command, AskOptions& ask) {
  add_data_option(command, ask.data, "rovers, soils and terrains");
  command.add_option("--url", ask.url, "ask a running service, http://HOST:PORT, instead of this process");
  command.add_flag("--json", ask.json, "print the whole document, for machines");
}

void add_why(CLI::App& command, AskOptions& ask) {
  command.add_flag("--why", ask.why, "print all that led to the verdict");
}

void add_model(CLI::App& command, AskOptions& ask) {
  CLI::Option* model = command.add_option(
      "--model", ask.model,
      "folder of a corrected model, as slipway diagnose --model writes it: its rover drives where the one "
      "that it was made of is asked for, and ground that was its nominal soil is the corrected one");
  model->excludes(command.get_option("--url"));
  command
      .add_option("--ground", ask.ground,
                  "a soil of the terrain that is the model's, where the campaign called it otherwise")
      ->needs(model);
}

}  // namespace slipway::server
