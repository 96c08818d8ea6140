#include "server/cli/commands/terrain_command.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "server/cli/commands/terrain_import_command.h"
#include "server/cli/inquiry/catalogue_printing.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_option.h"
#include "server/cli/inquiry/drive_answer.h"
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

namespace {

void add_import(CLI::App& terrain, std::function<int()>& run) {
  const auto options = std::make_shared<TerrainImportOptions>();
  api::TerrainImport& order = options->order;
  CLI::App* const command = terrain.add_subcommand(
      "import", "make a terrain of the data folder of an elevation map, and of a soil map");
  command
      ->add_option("DEM", order.elevation, "elevation map: GeoTIFF, ASCII grid, PDS, PDS4, ISIS, ENVI, EHdr")
      ->required();
  CLI::Option* const soil = command->add_option(
      "--soil", options->soil, "map of classes (a raster), or polygons of units (.geojson, .shp, .gpkg)");
  command
      ->add_option("--legend", options->legend,
                   "CSV value,label,soil: which soil each class is believed to be")
      ->needs(soil);
  command->add_option("--property", order.property, "of the polygons: the property that is the label")
      ->capture_default_str()
      ->needs(soil);
  command
      ->add_flag("--map-coordinates", options->map_coordinates,
                 "the polygons are in map metres, not in longitude and latitude")
      ->needs(soil);
  command->add_option("--assumption", order.assumption, "why these classes are believed to be these soils")
      ->needs(soil);
  command->add_option("--name", order.name, "name of the terrain; of the file where it is not given");
  command->add_option("--title", order.title, "what a person calls the place");
  command->add_option("--gravity", order.gravity_m_s2,
                      "m/s^2; of Mars, the Moon and the Earth it is known from the map");
  command->add_option("--licence", order.licence, "licence of the map, for PROVENANCE.md");
  command->add_option("--source", order.source, "where the map comes from, for PROVENANCE.md");
  command->add_option("--crs", order.crs,
                      "the map's system where the file names none or a wrong one: PROJ, WKT or a code");
  command
      ->add_option("--band", order.band,
                   "the band of heights, where the map has several and says of none that it is")
      ->check(CLI::PositiveNumber);
  command->add_option("--unit", order.unit,
                      "unit of the heights where the map names none or a wrong one: m, ft, us-ft, km");
  command->add_option("--nodata", order.nodata,
                      "also marks a missing height, as the file stores it, beside what the file says");
  command->add_flag("--strict", order.strict, "refuse a map that there is a warning of");
  command->add_flag("--fix", order.fix,
                    "mend what can be mended: degrees, feet, south-up or rotated grids, lengths that are not "
                    "the ground's");
  command->add_flag_callback(
      "--replace", [&order] { order.may_replace = [](const auto& /*there*/) { return true; }; },
      "replace a terrain of this name");
  command->add_flag("--json", options->json, "print JSON (terrain-import/1)");
  add_data_option(*command, options->data, "rovers, soils and terrains");
  command->footer(
      "Example:\n  slipway terrain import dem.tif --soil classes.tif --legend legend.csv --name site --fix\n"
      "Exit status: 0 done, 2 the map can't be used: every reason is told, with the command that mends it");
  command->callback([options, &run] { run = [options] { return import_terrain(*options); }; });
}

}  // namespace

void add_terrain_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<TerrainOptions>();
  CLI::App* command =
      app.add_subcommand("terrain", "what terrains there are, the ground at a point, or a map's import");
  add_ask(*command, options->ask);
  CLI::Option* const name =
      command->add_option("--name", options->name, "name of the terrain, with --at")->capture_default_str();
  add_place(*command, "--at", options->at, "x,y in map metres");
  name->needs("--at");
  command->add_flag("--lonlat", options->lonlat, "the point is longitude,latitude in degrees of the body")
      ->needs("--at");
  command->footer("Example:\n  slipway terrain --name gale --at 8142579.7,-276648.7");
  command->require_subcommand(0, 1);
  add_import(*command, run);
  // The callbacks of a command run after those of its subcommands.
  command->callback([command, options, &run] {
    if (command->get_subcommands().empty()) run = [options] { return terrain(*options); };
  });
}

}  // namespace slipway::server
