#include <CLI/CLI.hpp>
#include <memory>

#include "server/cli/data_option.h"
#include "server/cli/serve_command.h"

namespace slipway::server {

void add_serve_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<ServeOptions>();
  CLI::App* command = app.add_subcommand("serve", "answer over HTTP until interrupted");
  add_data_option(*command, options->data, "rovers, soils and terrains");
  command->add_option("--address", options->address, "address to listen on")->capture_default_str();
  command->add_option("--port", options->port, "port; 0 takes a free one")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  command->add_option("--jobs", options->jobs, "SQLite file of the jobs; \"\" keeps them in memory")
      ->capture_default_str();
  command
      ->add_option("--allow-origin", options->allowed_origins,
                   "let web pages of this origin, https://HOST[:PORT], read the answers; may be repeated")
      ->allow_extra_args(false);
  command->footer("Example:\n  slipway serve --port 8080\n  curl http://127.0.0.1:8080/v1/terrains");
  command->callback([options, &run] { run = [options] { return serve(*options); }; });
}

}  // namespace slipway::server
