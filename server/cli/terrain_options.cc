#include <CLI/CLI.hpp>
#include <memory>

#include "server/cli/terrain_command.h"

namespace slipway::server {

void add_terrain_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<TerrainOptions>();
  CLI::App* command = app.add_subcommand("terrain", "what terrains there are, or the ground at a point");
  add_ask(*command, options->ask);
  CLI::Option* const name =
      command->add_option("--name", options->name, "name of the terrain, with --at")->capture_default_str();
  add_place(*command, "--at", options->at, "x,y in map metres");
  name->needs("--at");
  command->footer("Example:\n  slipway terrain --name gale --at 8142579.7,-276648.7");
  command->callback([options, &run] { run = [options] { return terrain(*options); }; });
}

}  // namespace slipway::server
