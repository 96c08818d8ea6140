#include "server/cli/plan_command.h"

#include <vector>

#include "api/documents/plan_comparison.h"
#include "api/json/writer.h"
#include "server/cli/command_parts.h"
#include "server/cli/drive_answer.h"
#include "server/cli/drive_request.h"
#include "server/cli/terminal/tables.h"
#include "server/cli/terminal/terminal_progress.h"

namespace slipway::server {
namespace {

using api::json::Writer;

Result<std::string> plan_request(const PlanOptions& options) {
  Writer w;
  w.begin_object();
  if (auto written = write_drive(w, options.drive); !written) return fail(written.error());
  if (options.start) write_place(w.key("start"), *options.start);
  if (options.goal) write_place(w.key("goal"), *options.goal);
  if (!options.via.empty()) {
    w.key("waypoints").begin_array();
    for (const PlaceOption& place : options.via) write_place(w, place);
    w.end_array();
  }
  if (!options.weights.empty()) {
    w.key("weights").begin_object();
    for (const std::string& weight : options.weights) write_setting(w, weight);
    w.end_object();
  }
  if (options.routes) w.whole("routes", *options.routes);
  if (options.verify) w.whole("verify", *options.verify);
  if (options.rank_by || options.tail) {
    w.key("ranking").begin_object();
    if (options.rank_by) w.text("by", *options.rank_by);
    if (options.tail) w.exact("tail", *options.tail);
    w.end_object();
  }
  if (!options.planners.empty()) w.texts("planners", options.planners);
  w.end_object();
  return w.take();
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
  return deliver({}, *printed + (nominal.ask.json ? "\n" : ""));
}

}  // namespace

int plan(const PlanOptions& given) {
  const auto rover = models_rover(given.ask, given.drive.rover, !given.request.empty());
  if (!rover) return refuse(rover.error());
  PlanOptions options = given;
  options.drive.rover = *rover;
  if (options.drive.lonlat && options.request.empty()) {
    std::vector<PlaceOption*> places;
    for (auto* const end : {&options.start, &options.goal})
      if (*end) places.push_back(&**end);
    for (PlaceOption& place : options.via) places.push_back(&place);
    if (const auto brought = bring_to_map(options.ask, options.drive.terrain, places); !brought)
      return refuse(brought.error());
  }
  const auto request_of = [](const PlanOptions& o) {
    return o.request.empty() ? plan_request(o) : read_request(o.request);
  };
  const auto request = request_of(options);
  // A file's request is asked of both as it is, and standard input is read once.
  if (given.compare) {
    PlanOptions nominal = options;
    nominal.drive.rover = given.drive.rover;
    return compare_plans(nominal, given.request.empty() ? request_of(nominal) : request, options, request);
  }
  Pictures pictures = pictures_of(options.drive);
  pictures.commands = options.commands;
  pictures.route = options.route;
  return ask_and_print(options.ask, pictures, request, &Inquiry::plan, &plan_table, &plan_status);
}

}  // namespace slipway::server
