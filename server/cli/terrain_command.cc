#include "server/cli/terrain_command.h"

#include "server/cli/catalogue_printing.h"
#include "server/cli/command_parts.h"
#include "server/cli/drive_answer.h"
#include "server/cli/terminal/tables.h"

namespace slipway::server {

int terrain(const TerrainOptions& given) {
  TerrainOptions options = given;
  if (!options.at) return print_catalogue(options.ask, "terrains", &terrain_table);
  if (options.lonlat)
    if (const auto brought = bring_to_map(options.ask, options.name, {&*options.at}); !brought)
      return refuse(brought.error());
  const auto service = inquiry(options.ask);
  if (!service) return refuse(service.error());
  const auto ground = (*service)->ground_at(options.name, options.at->x_m, options.at->y_m);
  if (!ground) return refuse(ground.error());
  return deliver({}, *ground + "\n");
}

}  // namespace slipway::server
