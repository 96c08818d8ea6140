#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <sstream>

#include "planner/maps/map_kind.h"
#include "server/cli/map_command.h"

namespace slipway::server {
namespace {

constexpr const char* kMapExamples =
    "Examples:\n"
    "  slipway map slip_worst --terrain gale --rover msl-class --out slip.tif\n"
    "  slipway map verdict --terrain gale --rover mer-class --distance 20 --out verdict.tif\n"
    "  slipway map reachable --terrain gale --rover msl-class --from 8142579.73,-276648.74 --budget-sols 2 "
    "--out reachable.tif\n"
    "  slipway map contours --terrain gale --every 5 --out contours.gpkg\n"
    "Exit status: 0 written, 1 given up or not written, 2 options or files with faults.";

// "west,south,east,north".
dem::Extent extent_of(const std::string& text) {
  std::istringstream stream(text);
  double numbers[4] = {};
  for (int i = 0; i < 4; ++i) {
    char comma = ',';
    if (!(stream >> numbers[i]) || !std::isfinite(numbers[i]) || (i < 3 && !(stream >> comma)) ||
        comma != ',')
      throw CLI::ValidationError("--extent", "\"" + text + "\" must be WEST,SOUTH,EAST,NORTH in map metres");
  }
  if (stream.peek() != std::istringstream::traits_type::eof())
    throw CLI::ValidationError("--extent", "\"" + text + "\" must be WEST,SOUTH,EAST,NORTH in map metres");
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

void add_ways(CLI::App& command, MapOptions& options) {
  add_place(command, "--to", options.to, "x,y in map metres, of cost_to_go");
  add_place(command, "--from", options.from, "x,y in map metres, of reachable");
  command.add_option("--budget-j", options.budget_j, "energy of the drive motors that may be used, J");
  command.add_option("--budget-sols", options.budget_sols, "sols that may be used");
  command.add_option("--driving-hours-per-sol", options.hours_per_sol,
                     "hours of a sol that the rover drives; 4 where not given");
  command.add_option("--weight", options.weights,
                     "weight of a term of the cost, NAME=VALUE; see GET /v1/planners");
}

// An option that would be ignored is refused. What a request refuses by itself is not looked at here.
void refuse_ignored(const CLI::App& command, const std::string& kind) {
  const bool contours = kind == "contours";
  for (const CLI::Option* const option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || name == "KIND") continue;
    const bool of_contours = name == "--every" || name == "--base";
    const bool of_both = name == "--data" || name == "--json" || name == "--terrain" || name == "--rover" ||
                         name == "--out" || name == "--extent" || name == "--threads";
    const bool of_places = name == "--lonlat";
    const bool fits = of_both || (contours ? of_contours || of_places : !of_contours);
    const bool placed = contours || kind == "cost_to_go" || kind == "reachable";
    if (!fits || (of_places && !placed))
      throw CLI::ValidationError(name, "has no effect on a map of " + kind);
    if (name == "--resume" && placed)
      throw CLI::ValidationError(name, "has no effect on a map of " + kind + ": it has no tiles to keep");
  }
}

}  // namespace

void add_map_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<MapOptions>();
  CLI::App* const command =
      app.add_subcommand("map", "a map of the ground as a cloud-optimised GeoTIFF, or its contours");
  std::vector<std::string> kinds;
  for (const planner::MapKindRow& row : planner::map_kinds()) kinds.emplace_back(row.name);
  kinds.emplace_back("contours");
  command->add_option("KIND", options->kind, "what it shows")->required()->check(CLI::IsMember(kinds));
  add_local_ask(*command, options->ask);
  add_assumptions(*command, options->drive);
  command
      ->add_option("--out", options->out,
                   "file to write: .tif, of contours .gpkg or .geojson; styles for QGIS are put beside it")
      ->required();
  command->add_option(
      "--heading", options->heading_deg,
      "direction of travel, degrees counter-clockwise from east; the risks and the verdict are "
      "of all headings where it is not given");
  command->add_option("--distance", options->distance_m,
                      "length of the drive that risks and verdicts are of, m; 10 where not given");
  command->add_option_function<std::string>(
      "--extent", [options](const std::string& text) { options->extent = extent_of(text); },
      "WEST,SOUTH,EAST,NORTH in map metres; the whole terrain where it is not given");
  command
      ->add_option("--on-unknown", options->unknown,
                   "what slip and risk are where no map names the soil: nodata, or by its belief, which is "
                   "what --unknown-soil makes of it")
      ->check(CLI::IsMember({"nodata", "belief"}));
  add_ways(*command, *options);
  command->add_option("--every", options->every_m, "of contours: metres of height between two")
      ->capture_default_str()
      ->check(CLI::Range(1e-3, 1e5));
  command->add_option("--base", options->base_m, "of contours: a height that has one")->capture_default_str();
  command->add_flag(
      "--lonlat", options->lonlat,
      "places are longitude,latitude in degrees of the body, and so is the GeoJSON of contours");
  command->add_flag("--resume", options->resume,
                    "keep finished tiles in OUT.part whatever ends the work, and go on from there");
  command->add_option("--threads", options->threads, "0: as many as the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  command->footer(kMapExamples);
  command->callback([command, options, &run] {
    refuse_ignored(*command, options->kind);
    run = [options] { return map(*options); };
  });
}

}  // namespace slipway::server
