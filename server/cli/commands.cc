#include "server/cli/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <iostream>
#include <sstream>

#include "api/chart/drive_history.h"
#include "api/documents/plan_comparison.h"
#include "api/files/model_folder.h"
#include "api/json/writer.h"
#include "server/cli/command_parts.h"
#include "server/cli/inquiry.h"
#include "server/cli/tables.h"
#include "server/cli/terminal_progress.h"

namespace slipway::server {
namespace {

using api::json::Writer;

std::atomic<bool> interrupted{false};

Result<std::string> read_file(const std::string& path) {
  std::stringstream text;
  if (path == "-") {
    text << std::cin.rdbuf();
  } else {
    std::ifstream file(path);
    if (!file) return fail(ErrorCode::kUnreadableData, fmt::format("cannot open {}", path));
    text << file.rdbuf();
  }
  return text.str();
}

void write_place(Writer& w, const PlaceOption& place) {
  w.begin_object().exact("x_m", place.x_m).exact("y_m", place.y_m);
  if (place.yaw_deg) w.exact("yaw_deg", *place.yaw_deg);
  w.end_object();
}

void write_drive(Writer& w, const DriveOptions& drive) {
  w.text("terrain", drive.terrain).text("rover", drive.rover);
  if (drive.max_slip || drive.max_tilt_deg) {
    w.key("limits").begin_object();
    if (drive.max_slip) w.exact("max_slip", *drive.max_slip);
    if (drive.max_tilt_deg) w.exact("max_tilt_deg", *drive.max_tilt_deg);
    w.end_object();
  }
  if (!drive.effects.empty()) {
    w.key("effects").begin_array();
    for (const std::string& effect : drive.effects) write_effect(w, effect);
    w.end_array();
  }
  if (!drive.failed.empty()) {
    w.key("failed_wheels").begin_object();
    for (const std::string& failed : drive.failed) write_setting(w, failed);
    w.end_object();
  }
  if (drive.draws) w.whole("draws", *drive.draws);
  if (drive.seed) w.whole("seed", *drive.seed);
  if (drive.speed_m_s) w.exact("speed_m_s", *drive.speed_m_s);
  if (drive.motor_temp_c) w.exact("motor_temp_c", *drive.motor_temp_c);
}

std::string plan_request(const PlanOptions& options) {
  Writer w;
  w.begin_object();
  write_drive(w, options.drive);
  if (options.start) write_place(w.key("start"), *options.start);
  if (options.goal) write_place(w.key("goal"), *options.goal);
  if (!options.via.empty()) {
    w.key("waypoints").begin_array();
    for (const PlaceOption& place : options.via) write_place(w, place);
    w.end_array();
  }
  if (options.routes) w.whole("routes", *options.routes);
  if (options.verify) w.whole("verify", *options.verify);
  if (!options.planners.empty()) w.texts("planners", options.planners);
  w.end_object();
  return w.take();
}

std::string prediction_request(const PredictOptions& options) {
  Writer w;
  w.begin_object();
  write_drive(w, options.drive);
  w.key("path").begin_array();
  for (const PlaceOption& place : options.path) write_place(w, place);
  w.end_array();
  if (options.backwards) w.boolean("backwards", true);
  if (options.crab_deg) w.exact("crab_deg", *options.crab_deg);
  if (!options.rung.empty()) w.text("rung", options.rung);
  w.end_object();
  return w.take();
}

// Files for what is drawn of an answer; empty: not wanted.
struct Pictures {
  std::string map, history;
};

// Asks, prints the document or its table, and draws what is wanted.
int ask_and_print(const AskOptions& ask, const Pictures& pictures, Result<std::string> request,
                  Result<std::string> (Inquiry::*question)(const std::string&, Progress&),
                  Result<std::string> (*table)(std::string_view)) {
  if (!request) return refuse(request.error());
  const auto service = inquiry(ask);
  if (!service) return refuse(service.error());
  Result<std::string> answer;
  {
    TerminalProgress progress;
    answer = ((**service).*question)(*request, progress);
  }
  if (!answer) return refuse(answer.error());
  const auto printed = ask.json ? answer : table(*answer);
  if (!printed) return refuse(printed.error());
  std::cout << *printed << (ask.json ? "\n" : "") << std::flush;
  int status = 0;
  if (!pictures.map.empty()) {
    const auto map = (*service)->map();
    status = map ? save(pictures.map, *map) : refuse(map.error());
  }
  if (!pictures.history.empty()) {
    const auto history = api::draw_drive_history(*answer);
    status = std::max(status, history ? save(pictures.history, *history) : refuse(history.error()));
  }
  return status;
}

// The corrected rover, where the one that it was made of is asked for.
template <class Options>
Result<Options> with_models_rover(Options options) {
  if (options.ask.model.empty()) return options;
  const auto folder = api::load_model_folder(options.ask.model);
  if (!folder) return fail(folder.error());
  std::string& rover = options.drive.rover;
  if (rover == folder->nominal_rover) rover = folder->model.rover.name;
  // A request from a file names its own.
  if (options.request.empty() && rover != folder->model.rover.name)
    return fail(api::not_of_this_rover(*folder, rover));
  return options;
}

Result<std::string> plan_of(const AskOptions& ask, const Result<std::string>& request) {
  if (!request) return request;
  const auto service = inquiry(ask);
  if (!service) return fail(service.error());
  TerminalProgress progress;
  return (*service)->plan(*request, progress);
}

int compare_plans(const PlanOptions& nominal, const Result<std::string>& nominal_request,
                  const PlanOptions& corrected, const Result<std::string>& corrected_request) {
  AskOptions without = nominal.ask;
  without.model.clear();
  without.ground.clear();
  const auto before = plan_of(without, nominal_request);
  if (!before) return refuse(before.error());
  const auto after = plan_of(corrected.ask, corrected_request);
  if (!after) return refuse(after.error());
  const auto comparison = api::json::compare_plans(*before, *after);
  if (!comparison) return refuse(comparison.error());
  const auto printed = nominal.ask.json ? comparison : comparison_table(*comparison);
  if (!printed) return refuse(printed.error());
  std::cout << *printed << (nominal.ask.json ? "\n" : "") << std::flush;
  return 0;
}

int print_catalogue(const AskOptions& ask, std::string_view kind,
                    Result<std::string> (*table)(std::string_view)) {
  const auto service = inquiry(ask);
  if (!service) return refuse(service.error());
  const auto document = (*service)->catalogue(kind);
  if (!document) return refuse(document.error());
  const auto printed = ask.json ? document : table(*document);
  if (!printed) return refuse(printed.error());
  std::cout << *printed << (ask.json ? "\n" : "");
  return 0;
}

}  // namespace

int plan(const PlanOptions& given) {
  const auto options = with_models_rover(given);
  if (!options) return refuse(options.error());
  const auto request_of = [](const PlanOptions& o) {
    return o.request.empty() ? Result<std::string>(plan_request(o)) : read_file(o.request);
  };
  const auto request = request_of(*options);
  // A file's request is asked of both as it is, and standard input is read once.
  if (given.compare)
    return compare_plans(given, given.request.empty() ? request_of(given) : request, *options, request);
  return ask_and_print(options->ask, {.map = options->drive.map, .history = {}}, request, &Inquiry::plan,
                       &plan_table);
}

int predict(const PredictOptions& given) {
  const auto with_rover = with_models_rover(given);
  if (!with_rover) return refuse(with_rover.error());
  const PredictOptions& options = *with_rover;
  // Said before the work is done; of a request in a file its answer says it.
  if (!options.plot.empty() && options.request.empty() && options.rung != "dynamic")
    return refuse({ErrorCode::kInvalidRequest,
                   "there is no such plot",
                   {{"/plot", "only the dynamic rung has a time history: --rung dynamic"}}});
  return ask_and_print(
      options.ask, {.map = options.drive.map, .history = options.plot},
      options.request.empty() ? Result<std::string>(prediction_request(options)) : read_file(options.request),
      &Inquiry::predict, &prediction_table);
}

int terrain(const TerrainOptions& options) {
  if (!options.at) return print_catalogue(options.ask, "terrains", &terrain_table);
  const auto service = inquiry(options.ask);
  if (!service) return refuse(service.error());
  const auto ground = (*service)->ground_at(options.name, options.at->x_m, options.at->y_m);
  if (!ground) return refuse(ground.error());
  std::cout << *ground << "\n";
  return 0;
}

int rovers(const AskOptions& options) {
  return print_catalogue(options, "rovers", &rover_table);
}
int soils(const AskOptions& options) {
  return print_catalogue(options, "soils", &soil_table);
}
int effects(const AskOptions& options) {
  return print_catalogue(options, "effects", &effect_table);
}

int health(const AskOptions& options) {
  const auto service = inquiry(options);
  if (!service) return refuse(service.error());
  const auto document = (*service)->health();
  if (!document) return refuse(document.error());
  std::cout << *document << "\n";
  return 0;
}

void interrupt() {
  interrupted = true;
}

bool given_up() {
  return interrupted;
}

}  // namespace slipway::server
