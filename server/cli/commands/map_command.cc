#include "server/cli/commands/map_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <memory>
#include <sstream>
#include <system_error>
#include <utility>

#include "api/files/whole_file.h"
#include "api/json/parse.h"
#include "api/maps/contours.h"
#include "api/maps/map_documents.h"
#include "api/maps/map_layer.h"
#include "api/service.h"
#include "api/service_map.h"
#include "planner/maps/map_kind.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/inquiry/drive_answer.h"
#include "server/cli/inquiry/drive_request.h"
#include "server/cli/terminal/interruption.h"
#include "server/cli/terminal/terminal_progress.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

namespace fs = std::filesystem;
using api::json::Writer;

// Files that go away unless they are kept.
class Unfinished {
 public:
  explicit Unfinished(fs::path path) : path_(std::move(path)) {}
  ~Unfinished() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove(path_, ignored);
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  const fs::path& path() const { return path_; }
  void keep() { path_.clear(); }

 private:
  fs::path path_;
};

Result<std::string> request_of(const MapOptions& options) {
  Writer w;
  w.begin_object().text("kind", options.kind);
  if (const auto written = write_drive(w, options.drive); !written) return fail(written.error());
  if (options.heading_deg) w.exact("heading_deg", *options.heading_deg);
  if (options.distance_m) w.exact("distance_m", *options.distance_m);
  if (options.extent) {
    w.key("extent").begin_object().exact("west_m", options.extent->west_m);
    w.exact("south_m", options.extent->south_m).exact("east_m", options.extent->east_m);
    w.exact("north_m", options.extent->north_m).end_object();
  }
  const planner::MapKindRow* kind = nullptr;
  for (const planner::MapKindRow& row : planner::map_kinds())
    if (row.name == options.kind) kind = &row;
  const bool believes = !options.drive.unknown_soil.empty() && kind && !kind->of_classes && !kind->by_search;
  if (!options.unknown.empty() || believes)
    w.text("unknown_ground", options.unknown.empty() ? "belief" : options.unknown);
  if (options.to) write_place(w.key("to"), *options.to);
  if (options.from) write_place(w.key("from"), *options.from);
  if (options.budget_j || options.budget_sols) {
    w.key("budget").begin_object();
    if (options.budget_j) w.exact("energy_j", *options.budget_j);
    if (options.budget_sols) w.exact("sols", *options.budget_sols);
    w.end_object();
  }
  if (options.hours_per_sol) w.exact("driving_hours_per_sol", *options.hours_per_sol);
  if (!options.weights.empty()) {
    w.key("weights").begin_object();
    for (const std::string& weight : options.weights) write_setting(w, weight);
    w.end_object();
  }
  w.end_object();
  return w.take();
}

Result<fs::path> checked_out(const MapOptions& options) {
  const fs::path out = options.out;
  const std::string ending = out.extension().string();
  const bool contours = options.kind == "contours";
  const bool fits =
      contours ? ending == ".gpkg" || ending == ".geojson" : ending == ".tif" || ending == ".tiff";
  std::error_code error;
  if (!fits)
    return fail(ErrorCode::kInvalidRequest, "The file's name does not say what it is.",
                {{"--out", fmt::format("{} must end in {}", out.filename().string(),
                                       contours ? ".gpkg or .geojson" : ".tif")}});
  if (fs::is_directory(out, error) ||
      (!out.parent_path().empty() && !fs::is_directory(out.parent_path(), error)))
    return fail(ErrorCode::kUnwritableFile, fmt::format("{} can't be a file there", out.string()));
  return fs::absolute(out);
}

std::string words_of(const api::MapAnswer& answer, const fs::path& out) {
  const dem::GridGeometry& g = answer.layer.geometry;
  const api::MapStatistics& found = answer.statistics;
  const double all = static_cast<double>(found.cells);
  std::string text =
      fmt::format("{}: {}, {} x {} cells of {:g} m, {}\n", out.filename().string(), answer.layer.description,
                  g.columns, g.rows, g.cell_x_m, answer.provenance.crs_name);
  TextTable table({"cells", "share", "what"});
  for (const auto& [name, cells] : found.classes)
    table.add(
        {fmt::format("{}", cells), fmt::format("{:.1f} %", 100.0 * static_cast<double>(cells) / all), name});
  if (!answer.layer.of_classes && found.nodata < found.cells)
    table.add({fmt::format("{}", found.cells - found.nodata),
               fmt::format("{:.1f} %", 100.0 * static_cast<double>(found.cells - found.nodata) / all),
               fmt::format("with a value: {:.4g} to {:.4g}, mean {:.4g}", found.lowest, found.highest,
                           found.mean)});
  table.add({fmt::format("{}", found.nodata),
             fmt::format("{:.1f} %", 100.0 * static_cast<double>(found.nodata) / all), "nodata"});
  text += table.print();
  if (!answer.layer.of_classes && found.nodata == found.cells && !answer.request.price_unknown)
    text +=
        "No cell has a value: no map names the soil here, or the elevation is missing. --on-unknown "
        "belief or --unknown-soil NAME says what the ground is believed to be.\n";
  if (answer.tiles_kept > 0)
    text += fmt::format("{} tiles were there already and not computed again\n", answer.tiles_kept);
  return text;
}

// The map under its name, and what tools read beside it.
Result<void> put_in_place(const api::MapAnswer& answer, Unfinished& made, const fs::path& out) {
  std::error_code error;
  fs::path style = out;
  style.replace_extension(".qml");
  const fs::path categories = out.string() + ".aux.xml";
  if (const auto written = api::write_whole_file(style, api::map_style(answer.layer, answer.statistics));
      !written)
    return written;
  fs::remove(categories, error);  // of another map that had this name
  if (const std::string names = api::map_categories(answer.layer); !names.empty())
    if (const auto written = api::write_whole_file(categories, names); !written) return written;
  fs::rename(made.path(), out, error);
  if (error)
    return fail(ErrorCode::kUnwritableFile, fmt::format("cannot make {}: {}", out.string(), error.message()));
  made.keep();
  return {};
}

int draw_contours(const MapOptions& options, const fs::path& out) {
  const auto catalogue = open_catalogue(options.ask.data);
  if (!catalogue) return refuse_unreadable(catalogue.error());
  const auto site = catalogue->terrains.find(options.drive.terrain);
  if (site == catalogue->terrains.end())
    return refuse({ErrorCode::kInvalidRequest,
                   "There is no such terrain.",
                   {{"--terrain", api::unknown_terrain(*catalogue, options.drive.terrain)}}});
  TerminalProgress progress;
  const auto bytes = api::contours(*site->second,
                                   {.extent = options.extent,
                                    .every_m = options.every_m,
                                    .base_m = options.base_m,
                                    .geopackage = out.extension() == ".gpkg",
                                    .lonlat = options.lonlat},
                                   progress);
  if (!bytes) return refuse(bytes.error());
  return save({out.string(), *bytes});
}

int draw(const MapOptions& options, const fs::path& out) {
  const auto data = data_folder(options.ask.data);
  if (!data) return refuse_unreadable(data.error());
  const auto service =
      api::Service::open({.data = *data, .threads = static_cast<std::size_t>(options.threads)});
  if (!service) return refuse_unreadable(service.error());
  const auto text = request_of(options);
  if (!text) return refuse(text.error());
  const auto request = api::read_map(**service, *text);
  if (!request) return refuse(request.error());
  api::remove_abandoned(out.parent_path(), out.filename().string());
  Unfinished made(api::unfinished_name(out));
  Unfinished tiles(options.resume ? fs::path(out.string() + ".part") : api::unfinished_name(out));
  Result<api::MapAnswer> answer;
  {
    TerminalProgress progress;
    answer = api::run_map(**service, *request, {.out = made.path(), .part = tiles.path()}, progress);
  }
  if (!answer) {
    if (options.resume) tiles.keep();
    return refuse(answer.error());
  }
  if (const auto placed = put_in_place(*answer, made, out); !placed) return refuse(placed.error());
  return deliver({}, options.ask.json ? api::json::write_map_answer(*answer) + "\n" : words_of(*answer, out));
}

}  // namespace

int map(const MapOptions& given) {
  std::signal(SIGTERM, [](int) { interrupt(); });  // as Ctrl-C: nothing is left behind
  const auto out = checked_out(given);
  if (!out) return refuse(out.error());
  if (given.kind == "contours") return draw_contours(given, *out);
  MapOptions options = given;
  if (options.lonlat) {
    std::vector<PlaceOption*> places;
    for (auto* const place : {&options.to, &options.from})
      if (*place) places.push_back(&**place);
    if (const auto brought = bring_to_map(options.ask, options.drive.terrain, places); !brought)
      return refuse(brought.error());
  }
  return draw(options, *out);
}

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
