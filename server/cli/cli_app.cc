#include "server/cli/cli_app.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>

#include "api/service.h"
#include "server/cli/cli_campaign.h"
#include "server/cli/cli_check.h"
#include "server/cli/cli_data.h"
#include "server/cli/cli_diagnose.h"
#include "server/cli/cli_estimate.h"
#include "server/cli/cli_gap_benchmark.h"
#include "server/cli/cli_tune.h"
#include "server/cli/cli_wheel.h"
#include "server/cli/commands.h"
#include "server/cli/data_folder.h"
#include "sim/rover/wheel_failure.h"

namespace slipway::server {
namespace {

constexpr const char* kPlanExample =
    "Example: three routes between two places where Curiosity stopped, and a picture of them\n"
    "  slipway plan --terrain gale --rover msl-class --start 8142579.73,-276648.74 --goal "
    "8142566.40,-276711.67 --map routes.svg";
constexpr const char* kPredictExample =
    "Example: what the wheels do on a given path\n"
    "  slipway predict --path 8142579.7,-276648.7 8142578,-276680 8142566.4,-276711.7 --effect "
    "slip_sinkage:n1=0.2";

// "x,y" or "x,y,yaw_deg".
PlaceOption place_of(const std::string& text) {
  PlaceOption place;
  std::vector<double> numbers;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string part = text.substr(begin, comma - begin);
    std::size_t used = 0;
    try {
      numbers.push_back(std::stod(part, &used));
    } catch (const std::exception&) {
      used = 0;
    }
    if (used == 0 || used != part.size())
      throw CLI::ValidationError("\"" + text + "\" must be x,y or x,y,yaw_deg in map metres");
    begin = comma + 1;
  }
  if (numbers.size() < 2 || numbers.size() > 3)
    throw CLI::ValidationError("\"" + text + "\" must be x,y or x,y,yaw_deg in map metres");
  place.x_m = numbers[0];
  place.y_m = numbers[1];
  if (numbers.size() == 3) place.yaw_deg = numbers[2];
  return place;
}

void add_place(CLI::App& command, const std::string& name, std::optional<PlaceOption>& place,
               const std::string& help) {
  command.add_option_function<std::string>(
      name, [&place](const std::string& text) { place = place_of(text); }, help);
}

void add_places(CLI::App& command, const std::string& name, std::vector<PlaceOption>& places,
                const std::string& help) {
  command.add_option_function<std::vector<std::string>>(
      name,
      [&places](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) places.push_back(place_of(text));
      },
      help);
}

void add_ask(CLI::App& command, AskOptions& ask) {
  add_data_option(command, ask.data, "rovers, soils and terrains");
  command.add_option("--url", ask.url, "ask a running service, http://HOST:PORT, instead of this process");
  command.add_flag("--json", ask.json, "print the whole document, for machines");
}

void add_model(CLI::App& command, AskOptions& ask) {
  CLI::Option* model = command.add_option(
      "--model", ask.model,
      "folder of a corrected model, as slipway diagnose --model writes it: its rover drives where the one "
      "that "
      "it was made of is asked for, and ground that was its nominal soil is the corrected one");
  model->excludes(command.get_option("--url"));
  command
      .add_option("--ground", ask.ground,
                  "a soil of the terrain that is the model's, where the campaign called it otherwise")
      ->needs(model);
}

void add_drive(CLI::App& command, DriveOptions& drive) {
  command.add_option("--terrain", drive.terrain, "name of the terrain")->capture_default_str();
  command.add_option("--rover", drive.rover, "name of the rover")->capture_default_str();
  command.add_option("--max-slip", drive.max_slip, "limit of slip, 0 to 1");
  command.add_option("--max-tilt-deg", drive.max_tilt_deg, "limit of tilt");
  command.add_option("--speed-m-s", drive.speed_m_s, "commanded speed");
  command.add_option("--draws", drive.draws, "soil draws for the risk");
  command.add_option("--seed", drive.seed, "the same seed gives the same answer");
  command.add_option(
      "--effect", drive.effects,
      "switch an effect on, NAME or NAME:parameter=value,..., or off, NAME:off; see slipway effects");
  command.add_option("--failed", drive.failed,
                     fmt::format("a wheel whose drive has failed, WHEEL={}",
                                 fmt::join(sim::wheel_failure_names(), " or WHEEL=")));
  command.add_option("--motor-temp-c", drive.motor_temp_c, "temperature of the drive motors");
  command.add_option("--map", drive.map, "write a picture of the routes (SVG) to this file");
}

void add_validate(CLI::App& command, ValidateOptions& options) {
  add_data_option(command, options.data, "rovers, soils, terrains and validation data");
  CLI::Option* only =
      command.add_option("--only", options.only, "names of comparisons, see --list; all where not given");
  command.add_option("--plots", options.plots, "write one SVG per comparison into this folder");
  CLI::Option* check =
      command.add_option("--check", options.check, "also fail where this page does not hold what is printed");
  CLI::Option* write = command.add_option("--write", options.write, "put what is printed into this page");
  check->excludes(write)->excludes(only);
  write->excludes(only);
  command.add_flag("--json", options.json, "print the whole document, for machines");
  command.add_flag("--list", options.list, "what comparisons there are");
  command.footer(
      "Example: every comparison, with its pictures\n"
      "  slipway validate --plots plots\n"
      "Exit status: 0 every stated band holds, 1 one does not.");
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app("Traverse planning and slip-risk service for planetary rovers");
  app.require_subcommand(1);
  app.set_version_flag("--version", &version_text);
  app.footer(kPlanExample);
  std::function<int()> run;

  ServeOptions serve_options;
  CLI::App* command = app.add_subcommand("serve", "answer over HTTP until interrupted");
  add_data_option(*command, serve_options.data, "rovers, soils and terrains");
  command->add_option("--address", serve_options.address, "address to listen on")->capture_default_str();
  command->add_option("--port", serve_options.port, "port; 0 takes a free one")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  command->add_option("--jobs", serve_options.jobs, "SQLite file of the jobs; \"\" keeps them in memory")
      ->capture_default_str();
  command->footer("Example:\n  slipway serve --port 8080\n  curl http://127.0.0.1:8080/v1/terrains");
  command->callback([&] { run = [&] { return serve(serve_options); }; });

  PlanOptions plan_options;
  command = app.add_subcommand("plan", "propose routes, simulate and rank them");
  add_ask(*command, plan_options.ask);
  add_model(*command, plan_options.ask);
  add_drive(*command, plan_options.drive);
  command
      ->add_flag("--compare", plan_options.compare,
                 "plan with the nominal model too, and print what the corrected one changes")
      ->needs(command->get_option("--model"))
      ->excludes(command->get_option("--map"));
  add_place(*command, "--start", plan_options.start, "x,y or x,y,yaw_deg in map metres");
  add_place(*command, "--goal", plan_options.goal, "x,y or x,y,yaw_deg in map metres");
  add_places(*command, "--via", plan_options.via, "waypoints in order");
  command->add_option("--routes", plan_options.routes, "how many routes that differ");
  command->add_option("--verify", plan_options.verify, "how many of the best routes to verify by dynamics");
  command->add_option("--planner", plan_options.planners, "planners to use, see GET /v1/planners");
  command->add_option("--request", plan_options.request,
                      "file with a whole request, - for standard input; other options are not used");
  command->footer(kPlanExample);
  command->callback([&] { run = [&] { return plan(plan_options); }; });

  PredictOptions predict_options;
  command = app.add_subcommand("predict", "simulate a given path");
  add_ask(*command, predict_options.ask);
  add_model(*command, predict_options.ask);
  add_drive(*command, predict_options.drive);
  add_places(*command, "--path", predict_options.path, "corners of the path, each x,y or x,y,yaw_deg");
  command->add_flag("--backwards", predict_options.backwards, "drive the path backwards");
  command->add_option("--crab-deg", predict_options.crab_deg,
                      "direction of travel from the body's axis, positive to the left");
  command->add_option("--rung", predict_options.rung,
                      "quasi_static, or dynamic: drive the path as a multibody too");
  command->add_option("--plot", predict_options.plot,
                      "write the time history of the dynamic drive (SVG) to this file; needs that rung");
  command->add_option("--request", predict_options.request,
                      "file with a whole request, - for standard input; other options are not used");
  command->footer(kPredictExample);
  command->callback([&] { run = [&] { return predict(predict_options); }; });

  add_wheel_command(app, run);
  add_current_command(app, run);
  add_campaign_command(app, run);
  add_tune_command(app, run);
  add_diagnose_command(app, run);
  add_check_command(app, run);
  add_estimate_command(app, run);
  add_gap_benchmark_command(app, run);

  TerrainOptions terrain_options;
  command = app.add_subcommand("terrain", "what terrains there are, or the ground at a point");
  add_ask(*command, terrain_options.ask);
  command->add_option("--name", terrain_options.name, "name of the terrain, with --at")
      ->capture_default_str();
  add_place(*command, "--at", terrain_options.at, "x,y in map metres");
  command->footer("Example:\n  slipway terrain --name gale --at 8142579.7,-276648.7");
  command->callback([&] { run = [&] { return terrain(terrain_options); }; });

  ValidateOptions validate_options;
  command = app.add_subcommand("validate", "compare with published and measured data, and say how far off");
  add_validate(*command, validate_options);
  command->callback([&] { run = [&] { return validate(validate_options); }; });

  AskOptions ask;
  const std::map<std::string, std::pair<std::string, int (*)(const AskOptions&)>> lists{
      {"rovers", {"what rovers there are", &rovers}},
      {"soils", {"what soils there are, with their sources", &soils}},
      {"effects", {"what effects can be switched on, with their parameters", &effects}},
      {"health", {"whether a service answers", &health}}};
  for (const auto& [name, about] : lists) {
    command = app.add_subcommand(name, about.first);
    add_ask(*command, ask);
    command->footer("Example:\n  slipway " + name + " --json");
    command->callback([&run, &ask, answer = about.second] { run = [&ask, answer] { return answer(ask); }; });
  }

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error);
    return status == 0 ? 0 : 2;
  }
  return run();
}

}  // namespace slipway::server
