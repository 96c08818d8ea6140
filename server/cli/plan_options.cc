#include <CLI/CLI.hpp>
#include <memory>

#include "server/cli/plan_command.h"

namespace slipway::server {
namespace {

constexpr const char* kPlanExample =
    "Example: three routes between two places where Curiosity stopped, and a picture of them\n"
    "  slipway plan --terrain gale --rover msl-class --start 8142579.73,-276648.74 --goal "
    "8142566.40,-276711.67 --map routes.svg\n"
    "and the commands of the best one, with all that is assumed of the drive, for slipway check\n"
    "  slipway plan --start 8142579.73,-276648.74 --goal 8142566.40,-276711.67 --commands route.json\n"
    "  slipway check --commands route.json";

}  // namespace

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
  add_place(*command, "--start", options->start, "x,y or x,y,yaw_deg in map metres");
  add_place(*command, "--goal", options->goal, "x,y or x,y,yaw_deg in map metres");
  add_places(*command, "--via", options->via, "waypoints in order");
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
  CLI::Option* const commands = command->add_option(
      "--commands", options->commands,
      "write the commands of the best route to this file: a table where it ends in .csv, otherwise the whole "
      "request of a check (JSON)");
  commands->excludes(command->get_option("--compare"));
  command->add_option("--route", options->route, "whose commands, by rank; 1 where not given")
      ->needs(commands);
  command->add_option("--request", options->request,
                      "file with a whole request, - for standard input; other options are not used");
  command->footer(kPlanExample);
  command->callback([options, &run] { run = [options] { return plan(*options); }; });
}

}  // namespace slipway::server
