#include "server/cli/inquiry/drive_answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "api/chart/drive_history.h"
#include "api/documents/drive_commands.h"
#include "api/export/answer_vectors.h"
#include "api/export/station_csv.h"
#include "api/files/model_folder.h"
#include "api/json/parse.h"
#include "core/angle.h"
#include "dem/body_degrees.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/drive_request.h"
#include "server/cli/inquiry/kernel_files.h"
#include "server/cli/terminal/terminal_progress.h"

namespace slipway::server {
namespace {

// An answer of ours: whoever prints it has read it already.
api::json::JsonValue read_answer(std::string_view answer) {
  return api::json::parse(answer, {.bytes = answer.size(), .values = answer.size()}).value();
}

// The map of the answer's terrain, by whoever answered.
Result<api::json::AnswerMap> map_of(Inquiry& service, const std::string& terrain) {
  const auto terrains = service.catalogue("terrains");
  if (!terrains) return fail(terrains.error());
  return api::json::map_of_terrain(*terrains, terrain);
}

Result<std::string> vectors_of(Inquiry& service, const std::string& answer, bool geopackage, bool lonlat) {
  const auto map = map_of(service, api::json::terrain_of_answer(answer).name);
  if (!map) return fail(map.error());
  api::json::TablePages stations;
  if (api::json::is_thinned(answer)) {
    auto all = service.stations();
    if (!all) return fail(all.error());
    stations = api::json::in_one_page(*std::move(all));
  }
  if (geopackage) return api::json::answer_geopackage(answer, *map, std::move(stations));
  using api::json::VectorCoordinates;
  return api::json::answer_geojson(answer, *map,
                                   lonlat ? VectorCoordinates::kLongitudeLatitude : VectorCoordinates::kMap,
                                   std::move(stations));
}

Result<std::string> commands_of(const std::string& answer, const Pictures& pictures) {
  const api::json::JsonValue document = read_answer(answer);
  const api::json::JsonValue* const of_sol = document.find("plan");
  const api::json::JsonValue& plan = of_sol != nullptr ? *of_sol : document;
  if (pictures.commands.ends_with(".csv")) return api::json::commands_table(plan, pictures.route);
  auto request = api::json::check_of_route(plan, pictures.route);
  if (!request) return request;
  return *request + "\n";
}

// The fault of a place in degrees; nothing where it was brought to the map.
std::optional<std::string> bring_place(PlaceOption& place, const api::json::AnswerMap& map,
                                       const dem::BodyDegrees& degrees) {
  const dem::MapPlace given{place.x_m, place.y_m};
  const bool possible = std::abs(given.x) <= 720.0 && std::abs(given.y) <= 90.0;
  std::optional<dem::MapPlace> found;
  if (possible) found = degrees.to_map(given);
  std::string meant;
  if (map.extent && !(found && map.extent->contains(found->x, found->y)))
    meant = dem::likely_mistake(map.crs_wkt, map.body, *map.extent, given, true);
  if (meant.empty() && !possible) meant = ": these are map metres";
  if (!found || !meant.empty())
    return fmt::format("{},{} is no longitude,latitude in degrees on this map{}", given.x, given.y, meant);
  place.x_m = found->x;
  place.y_m = found->y;
  return std::nullopt;
}

// What --day says of the light that is to be left; a text that is no number is refused with the request.
double light_left_h(const std::vector<std::string>& day) {
  constexpr std::string_view kKey = "light_left_h=";
  double hours = 0.0;
  for (const std::string& setting : day)
    if (setting.starts_with(kKey)) hours = std::strtod(setting.c_str() + kKey.size(), nullptr);
  return std::clamp(hours, 0.0, 1000.0);
}

}  // namespace

Pictures pictures_of(const DriveOptions& drive) {
  return {.map = drive.map,
          .csv = drive.csv,
          .gpkg = drive.gpkg,
          .geojson = drive.geojson,
          .lonlat = drive.lonlat};
}

Result<void> bring_to_map(const AskOptions& ask, const std::string& terrain,
                          const std::vector<PlaceOption*>& places) {
  const auto service = inquiry(ask);
  if (!service) return fail(service.error());
  const auto map = map_of(**service, terrain);
  if (!map) return fail(map.error());
  const dem::BodyDegrees degrees(map->crs_wkt, map->body, map->extent);
  std::vector<Fault> faults;
  for (PlaceOption* const place : places)
    if (auto fault = bring_place(*place, *map, degrees)) faults.push_back({"--lonlat", *std::move(fault)});
  if (!faults.empty())
    return fail(ErrorCode::kInvalidRequest, "Places can't be brought to the map.", std::move(faults));
  return {};
}

Result<void> make_sky(const AskOptions& ask, DriveOptions& drive, const PlaceOption* start) {
  if (!drive.depart || std::none_of(drive.sky.begin(), drive.sky.end(), is_kernel_file)) return {};
  const auto refused = [](std::string why, std::vector<Fault> faults = {}) {
    return fail(ErrorCode::kInvalidRequest, std::move(why), std::move(faults));
  };
  if (start == nullptr)
    return refused("a sky of kernels is made over the place where the drive starts: give --start, or --path");
  const auto times = time_span("--depart", *drive.depart);
  if (!times) return {};  // whoever reads the request names it, beside what else is wrong
  const auto service = inquiry(ask);
  if (!service) return fail(service.error());
  const auto map = map_of(**service, drive.terrain);
  if (!map) return fail(map.error());
  const auto degrees =
      dem::BodyDegrees(map->crs_wkt, map->body, map->extent).to_degrees({start->x_m, start->y_m});
  if (!degrees)
    return refused(fmt::format("--sky: the start ({:g}, {:g}) has no longitude and latitude on the map of {}",
                               start->x_m, start->y_m, drive.terrain));
  constexpr double kBehind_h = 240.0;
  const auto sky = read_kernel_sky(drive.sky, map->body);
  if (!sky) return refused("--sky: " + sky.error().detail, sky.error().faults);
  auto moments =
      sky->table({rad_from_deg(degrees->x), rad_from_deg(degrees->y)}, times->from_ms, times->to_ms,
                 times->to_ms + std::llround(3.6e6 * (kBehind_h + light_left_h(drive.day))),
                 api::RequestLimits::kSkyMoments);
  if (!moments) return refused("--sky: " + moments.error().detail, moments.error().faults);
  drive.sky_of_kernels = *std::move(moments);
  return {};
}

int ask_and_print(const AskOptions& ask, const Pictures& pictures, const Result<std::string>& request,
                  Result<std::string> (Inquiry::*question)(const std::string&, Progress&),
                  Result<std::string> (*table)(std::string_view, bool why),
                  ExitStatus (*verdict)(std::string_view), const std::function<Error(Error)>& placed) {
  if (!request) return refuse_unreadable(request.error());
  const auto service = inquiry(ask);
  if (!service) return refuse(service.error());
  Result<std::string> answer;
  {
    TerminalProgress progress;
    answer = ((**service).*question)(*request, progress);
  }
  if (!answer) return refuse(placed ? placed(answer.error()) : answer.error());
  const auto printed = ask.json ? answer : table(*answer, ask.why);
  if (!printed) return refuse(printed.error());
  std::vector<OutputFile> files;
  std::optional<Error> unmade;
  const auto add = [&](const std::string& path, Result<std::string> made) {
    if (made)
      files.push_back({path, *std::move(made)});
    else
      unmade = made.error();
  };
  if (!pictures.map.empty()) add(pictures.map, (*service)->map());
  if (!pictures.history.empty()) add(pictures.history, api::draw_drive_history(*answer));
  if (!pictures.report.empty()) add(pictures.report, (*service)->report());
  if (!pictures.csv.empty()) add(pictures.csv, (*service)->stations());
  if (!pictures.gpkg.empty()) add(pictures.gpkg, vectors_of(**service, *answer, true, false));
  if (!pictures.geojson.empty())
    add(pictures.geojson, vectors_of(**service, *answer, false, pictures.lonlat));
  if (!pictures.commands.empty()) add(pictures.commands, commands_of(*answer, pictures));
  const int status = deliver(files, *printed + (ask.json ? "\n" : ""));
  if (unmade) return refuse(*unmade);
  return status == kDone ? verdict(*answer) : status;
}

ExitStatus check_status(std::string_view check) {
  return status_of(read_answer(check).find("verdict")->text);
}

ExitStatus prediction_status(std::string_view prediction) {
  return status_of(read_answer(prediction).find("decision")->find("verdict")->text);
}

ExitStatus plan_status(std::string_view plan) {
  const api::json::JsonValue document = read_answer(plan);
  const auto& routes = document.find("summary")->elements;
  return routes.empty() ? kNoGo : status_of(routes.front().find("verdict")->text);
}

Result<std::string> models_rover(const AskOptions& ask, const std::string& rover, bool any_rover) {
  if (ask.model.empty()) return rover;
  const auto folder = api::load_model_folder(ask.model);
  if (!folder) return fail(folder.error());
  const std::string& corrected = folder->model.rover.name;
  if (rover == folder->nominal_rover || rover == corrected) return corrected;
  if (!any_rover) return fail(api::not_of_this_rover(*folder, rover));
  return rover;
}

}  // namespace slipway::server
