#include "server/cli/commands/plan_command.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <vector>

#include "api/documents/plan_comparison.h"
#include "api/json/writer.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/drive_answer.h"
#include "server/cli/inquiry/drive_request.h"
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
  if (!options.start_error.empty()) {
    w.key("start_error").begin_object();
    for (const std::string& setting : options.start_error) write_setting(w, setting);
    w.end_object();
  }
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

// What comes before a request of options: places in degrees are brought to the map, and kernels become a sky.
Result<void> prepare(PlanOptions& options) {
  if (!options.request.empty()) return {};
  if (options.drive.lonlat) {
    std::vector<PlaceOption*> places;
    for (auto* const end : {&options.start, &options.goal})
      if (*end) places.push_back(&**end);
    for (PlaceOption& place : options.via) places.push_back(&place);
    if (auto brought = bring_to_map(options.ask, options.drive.terrain, places); !brought) return brought;
  }
  return make_sky(options.ask, options.drive, options.start ? &*options.start : nullptr);
}

}  // namespace

int plan(const PlanOptions& given) {
  const auto rover = models_rover(given.ask, given.drive.rover, !given.request.empty());
  if (!rover) return refuse(rover.error());
  PlanOptions options = given;
  options.drive.rover = *rover;
  if (const auto prepared = prepare(options); !prepared) return refuse(prepared.error());
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
  return ask_and_print(options.ask, pictures, request, &Inquiry::plan, &plan_table, &plan_status,
                       placed_on_command_line(options.drive));
}

int sol(const PlanOptions& given) {
  PlanOptions options = given;
  if (const auto prepared = prepare(options); !prepared) return refuse(prepared.error());
  const auto request = options.request.empty() ? plan_request(options) : read_request(options.request);
  Pictures pictures;
  pictures.report = options.report;
  pictures.commands = options.commands;
  return ask_and_print(options.ask, pictures, request, &Inquiry::sol, &sol_table, &check_status,
                       placed_on_command_line(options.drive));
}

namespace {

constexpr const char* kPlanExample =
    "Example: three routes between two places where Curiosity stopped, and a picture of them\n"
    "  slipway plan --terrain gale --rover msl-class --start 8142579.73,-276648.74 --goal "
    "8142566.40,-276711.67 --map routes.svg\n"
    "and the commands of the best one, with all that is assumed of the drive, for slipway check\n"
    "  slipway plan --start 8142579.73,-276648.74 --goal 8142566.40,-276711.67 --commands route.json\n"
    "  slipway check --commands route.json";

void add_ends(CLI::App& command, PlanOptions& options) {
  add_place(command, "--start", options.start, "x,y or x,y,yaw_deg in map metres");
  command.add_option("--start-error", options.start_error,
                     "how wrong the start may be, NAME=VALUE: position_m along each axis and heading_deg, 1 "
                     "sigma; the drive is judged from 25 starts");
  add_place(command, "--goal", options.goal, "x,y or x,y,yaw_deg in map metres");
  add_places(command, "--via", options.via, "waypoints in order");
}

CLI::Option* add_commands_file(CLI::App& command, PlanOptions& options) {
  return command.add_option(
      "--commands", options.commands,
      "write the commands of the best route to this file: a table where it ends in .csv, otherwise the whole "
      "request of a check (JSON)");
}

}  // namespace

void add_sol_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<PlanOptions>();
  CLI::App* command = app.add_subcommand(
      "sol", "a sol for the meeting: the route that fits into the day, its checks, its way back");
  add_ask(*command, options->ask);
  add_why(*command, options->ask);
  add_drive(*command, options->drive);
  add_ends(*command, *options);
  command->add_option("--routes", options->routes, "how many routes that differ");
  command->add_option("--request", options->request,
                      "file with a whole request, - for standard input; other options are not used");
  command->add_option("--report", options->report, "write the page to this file (HTML)");
  add_commands_file(*command, *options);
  command->footer(
      "Example:\n  slipway sol --start 8142579.73,-276648.74 --goal 8142566.40,-276711.67 --depart "
      "2016-03-22T00:00:00Z..2016-03-23T00:00:00Z --day min_sun_deg=10 --report sol.html");
  command->callback([options, &run] { run = [options] { return sol(*options); }; });
}

void add_plan_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<PlanOptions>();
  CLI::App* command = app.add_subcommand("plan", "propose routes, simulate and rank them");
  add_ask(*command, options->ask);
  add_why(*command, options->ask);
  add_model(*command, options->ask);
  add_drive(*command, options->drive);
  command
      ->add_flag("--compare", options->compare,
                 "plan with the nominal model too, and print what the corrected one changes")
      ->needs(command->get_option("--model"))
      ->excludes(command->get_option("--map"));
  add_ends(*command, *options);
  command->add_option("--routes", options->routes, "how many routes that differ");
  command->add_option("--verify", options->verify, "how many of the best routes to verify by dynamics");
  command->add_option("--weight", options->weights,
                      "weight of a term of the cost, NAME=VALUE; see GET /v1/planners");
  command->add_option("--planner", options->planners, "planners to use, see GET /v1/planners");
  command->add_option(
      "--rank-by", options->rank_by,
      "what ranks the routes: expected, the mean cost over the draws, or cvar, the mean of the "
      "dearest of them");
  command->add_option("--tail", options->tail,
                      "share of the draws of which cvar is the mean; 0.1 where not given");
  CLI::Option* const commands = add_commands_file(*command, *options);
  commands->excludes(command->get_option("--compare"));
  command->add_option("--route", options->route, "whose commands, by rank; 1 where not given")
      ->needs(commands);
  command->add_option("--request", options->request,
                      "file with a whole request, - for standard input; other options are not used");
  command->footer(kPlanExample);
  command->callback([options, &run] { run = [options] { return plan(*options); }; });
}

}  // namespace slipway::server
