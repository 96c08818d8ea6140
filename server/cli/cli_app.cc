#include "server/cli/cli_app.h"

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "server/cli/commands/campaign_command.h"
#include "server/cli/commands/catalogue_command.h"
#include "server/cli/commands/check_command.h"
#include "server/cli/commands/compare_answers_command.h"
#include "server/cli/commands/current_command.h"
#include "server/cli/commands/data_check_command.h"
#include "server/cli/commands/diagnose_command.h"
#include "server/cli/commands/estimate_command.h"
#include "server/cli/commands/import_command.h"
#include "server/cli/commands/map_command.h"
#include "server/cli/commands/plan_command.h"
#include "server/cli/commands/predict_command.h"
#include "server/cli/commands/serve_command.h"
#include "server/cli/commands/sky_command.h"
#include "server/cli/commands/steps_command.h"
#include "server/cli/commands/study_command.h"
#include "server/cli/commands/terrain_command.h"
#include "server/cli/commands/test_model_command.h"
#include "server/cli/commands/tune_command.h"
#include "server/cli/commands/watch_command.h"
#include "server/cli/commands/wheel_command.h"
#include "server/cli/inquiry/command_line.h"
#include "server/cli/inquiry/data_folder.h"

namespace slipway::server {
int run_command_line(int argc, char** argv) {
  CLI::App app("Traverse planning and slip-risk service for planetary rovers");
  app.require_subcommand(1);
  app.set_version_flag("--version", &version_text);
  std::function<int()> run;
  add_serve_command(app, run);
  add_plan_command(app, run);
  add_sol_command(app, run);
  add_predict_command(app, run);
  add_wheel_command(app, run);
  add_current_command(app, run);
  add_campaign_command(app, run);
  add_import_command(app, run);
  add_tune_command(app, run);
  add_diagnose_command(app, run);
  add_watch_command(app, run);
  add_check_command(app, run);
  add_compare_answers_command(app, run);
  add_test_model_command(app, run);
  add_estimate_command(app, run);
  add_terrain_command(app, run);
  add_sky_command(app, run);
  add_map_command(app, run);
  add_data_command(app, run);
  add_steps_command(app, run);
  add_study_commands(app, run);
  add_catalogue_commands(app, run);
  app.footer(app.get_subcommand("plan")->get_footer());
  return parse_and_run(app, run, argc, argv);
}

}  // namespace slipway::server
