#include <CLI/CLI.hpp>
#include <memory>

#include "server/cli/check_command.h"

namespace slipway::server {
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
