#include "server/cli/commands/check_command.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "api/json/writer.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/commands_file.h"
#include "server/cli/inquiry/drive_answer.h"
#include "server/cli/inquiry/drive_request.h"
#include "server/cli/terminal/tables.h"

namespace slipway::server {
namespace {

using api::json::Writer;

// "drive=5", "turn=-30" or "arc=4,6" (length, radius); what is none of these is left to the request's reader.
void write_command(Writer& w, const std::string& command) {
  const std::size_t equals = command.find('=');
  const std::string kind = command.substr(0, equals);
  const std::string value = equals == std::string::npos ? std::string() : command.substr(equals + 1);
  w.begin_object();
  if (kind == "arc") {
    const std::size_t comma = value.find(',');
    write_setting(w, "arc_m=" + value.substr(0, comma));
    if (comma != std::string::npos) write_setting(w, "radius_m=" + value.substr(comma + 1));
  } else {
    write_setting(w, (kind == "turn" ? "turn_deg" : kind == "drive" ? "drive_m" : kind) + "=" + value);
  }
  w.end_object();
}

Result<std::string> check_request(const CheckOptions& options) {
  Writer w;
  w.begin_object();
  if (auto written = write_drive(w, options.drive); !written) return fail(written.error());
  if (!options.path.empty()) {
    w.key("path").begin_array();
    for (const PlaceOption& place : options.path) write_place(w, place);
    w.end_array();
  }
  if (options.start) write_place(w.key("start"), *options.start);
  if (!options.commands.empty()) {
    w.key("commands").begin_array();
    for (const std::string& command : options.commands) write_command(w, command);
    w.end_array();
  }
  if (!options.rules.empty()) w.text("rules", options.rules);
  if (options.backwards) w.boolean("backwards", true);
  if (options.crab_deg) w.exact("crab_deg", *options.crab_deg);
  w.end_object();
  return w.take();
}

// Where the drive starts; null where the command line does not say.
const PlaceOption* start_of(const CheckOptions& options) {
  if (options.start) return &*options.start;
  return options.path.empty() ? nullptr : &options.path.front();
}

// Of the commands of a file: what is given on the command line stands over what it says.
int check_file(CheckOptions options, const Pictures& pictures) {
  const auto bytes = read_request(options.commands_file);
  if (!bytes) return refuse_unreadable(bytes.error());
  const auto file = CommandsFile::read(*bytes, options.commands_file);
  if (!file) return refuse(file.error());
  if (!options.names_terrain && file->names("terrain")) options.drive.terrain.clear();
  if (!options.names_rover && file->names("rover")) options.drive.rover.clear();
  DriveOptions over_file = options.drive;
  if (over_file.terrain.empty()) over_file.terrain = file->terrain();
  const auto starts = file->start();
  const PlaceOption* const start = start_of(options);
  if (const auto made = make_sky(options.ask, over_file, start == nullptr && starts ? &*starts : start);
      !made)
    return refuse(made.error());
  options.drive.sky_of_kernels = std::move(over_file.sky_of_kernels);
  const auto given = check_request(options);
  if (!given) return refuse(given.error());
  return ask_and_print(options.ask, pictures, file->request_with(*given), &Inquiry::check, &check_table,
                       &check_status, [&](Error error) {
                         return file->placed(placed_on_command_line(options.drive)(std::move(error)), *given);
                       });
}

}  // namespace

int check(const CheckOptions& given) {
  const auto rover =
      models_rover(given.ask, given.drive.rover, !given.request.empty() || !given.commands_file.empty());
  if (!rover) return refuse(rover.error());
  CheckOptions options = given;
  options.drive.rover = *rover;
  if (options.drive.lonlat && options.request.empty()) {
    std::vector<PlaceOption*> places;
    if (options.start) places.push_back(&*options.start);
    for (PlaceOption& place : options.path) places.push_back(&place);
    if (const auto brought = bring_to_map(options.ask, options.drive.terrain, places); !brought)
      return refuse(brought.error());
  }
  if (options.request.empty() && options.commands_file.empty())
    if (const auto made = make_sky(options.ask, options.drive, start_of(options)); !made)
      return refuse(made.error());
  Pictures pictures = pictures_of(options.drive);
  pictures.report = options.report;
  if (!options.commands_file.empty()) return check_file(std::move(options), pictures);
  return ask_and_print(options.ask, pictures,
                       options.request.empty() ? check_request(options) : read_request(options.request),
                       &Inquiry::check, &check_table, &check_status, placed_on_command_line(options.drive));
}

namespace {

constexpr const char* kCheckExample =
    "Example: may this drive be commanded?\n"
    "  slipway check --path 8142579.7,-276648.7 8142578,-276680 --rules every_5_m\n"
    "  slipway check --path 8142579.7,-276648.7 8142578,-276680 --report check.html --csv stations.csv\n"
    "  slipway check --commands route.json\n"
    "  slipway check --start 8142579.7,-276648.7,-90 --command drive=10 turn=30 arc=6,8\n"
    "Exit status: 0 GO, 3 NO-GO, 4 UNKNOWN; 1 no answer, 2 a request that can't be used, with every fault.";

}  // namespace

void add_check_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand("check", "GO, NO-GO or UNKNOWN for a path or a command sequence");
  // What this command was before it checked drives.
  command
      ->add_option_function<std::string>(
          "campaign",
          [](const std::string& folder) {
            throw CLI::ValidationError(
                "slipway check " + folder +
                ": to test a corrected model on a campaign's drives, use slipway test-model");
          },
          "")
      ->group("");
  add_ask(*command, options->ask);
  add_why(*command, options->ask);
  add_model(*command, options->ask);
  add_drive(*command, options->drive);
  add_places(*command, "--path", options->path, "corners of the path, each x,y or x,y,yaw_deg");
  add_place(*command, "--start", options->start, "where a command sequence begins: x,y,yaw_deg");
  CLI::Option* const file = command->add_option(
      "--commands", options->commands_file,
      "file with a command sequence, as slipway plan --commands writes it (CSV or JSON), - for standard "
      "input; options beside it stand over what it says");
  command
      ->add_option("--command", options->commands,
                   "the sequence itself: drive=METRES, turn=DEGREES, arc=METRES,RADIUS (left positive)")
      ->excludes(file);
  file->excludes(command->get_option("--path"));
  command->add_option("--rules", options->rules, "a set of rules of the data folder, by name");
  command->add_flag("--backwards", options->backwards, "drive backwards");
  command->add_option("--crab-deg", options->crab_deg,
                      "direction of travel from the body's axis, positive to the left");
  command->add_option("--report", options->report, "write one page for a meeting (HTML) to this file");
  command
      ->add_option("--request", options->request,
                   "file with a whole request, - for standard input; other options are not used")
      ->excludes(file);
  command->footer(kCheckExample);
  command->callback([options, command, &run] {
    options->names_terrain = command->count("--terrain") > 0;
    options->names_rover = command->count("--rover") > 0;
    run = [options] { return check(*options); };
  });
}

}  // namespace slipway::server
