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
  command->add_option("--keep-jobs", options->keep_jobs, "ended jobs that are kept at most")
      ->capture_default_str()
      ->check(CLI::Range(0, 10'000'000));
  command->add_option("--keep-days", options->keep_days, "days for which ended jobs are kept at most")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 36500.0));
  command
      ->add_option("--keep-mb", options->keep_mb, "megabytes of requests and answers of ended jobs at most")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e7));
  command->add_option("--max-connections", options->max_connections, "connections at once")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  command
      ->add_option("--max-connections-per-address", options->max_connections_per_address,
                   "connections of one address at once; 0: no limit, for a server behind a reverse proxy")
      ->capture_default_str()
      ->check(CLI::Range(0, 1'000'000));
  command
      ->add_option("--allow-host", options->allowed_hosts,
                   "answer under this name too, beside localhost and addresses as numbers; may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option("--allow-origin", options->allowed_origins,
                   "let web pages of this origin, https://HOST[:PORT], read the answers; may be repeated")
      ->allow_extra_args(false);
  command->footer("Example:\n  slipway serve --port 8080\n  curl http://127.0.0.1:8080/v1/terrains");
  command->callback([options, &run] { run = [options] { return serve(*options); }; });
}

}  // namespace slipway::server
