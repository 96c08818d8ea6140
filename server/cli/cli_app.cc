#include "server/cli/cli_app.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <functional>
#include <string>

#include "server/cli/campaign_command.h"
#include "server/cli/catalogue_command.h"
#include "server/cli/check_command.h"
#include "server/cli/compare_answers_command.h"
#include "server/cli/current_command.h"
#include "server/cli/data_check_command.h"
#include "server/cli/diagnose_command.h"
#include "server/cli/estimate_command.h"
#include "server/cli/gap_benchmark_command.h"
#include "server/cli/import_command.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/map_command.h"
#include "server/cli/plan_command.h"
#include "server/cli/predict_command.h"
#include "server/cli/serve_command.h"
#include "server/cli/steps_command.h"
#include "server/cli/terrain_command.h"
#include "server/cli/test_model_command.h"
#include "server/cli/tune_command.h"
#include "server/cli/validate_command.h"
#include "server/cli/watch_command.h"
#include "server/cli/wheel_command.h"
#include "server/cli/worlds_command.h"

namespace slipway::server {
namespace {

// CLI11 reads "nan" and "inf" as numbers; here they never are: every option that is a number refuses them.
void refuse_what_is_not_finite(CLI::App& app) {
  const CLI::Validator finite(
      [](std::string& text) -> std::string {
        double number = 0.0;
        return CLI::detail::lexical_cast(text, number) && !std::isfinite(number)
                   ? text + " is not a finite number"
                   : "";
      },
      "");
  for (CLI::Option* const option : app.get_options())
    if (option->get_type_name().find("FLOAT") != std::string::npos) option->check(finite);
  for (CLI::App* const command : app.get_subcommands({})) refuse_what_is_not_finite(*command);
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app("Traverse planning and slip-risk service for planetary rovers");
  app.require_subcommand(1);
  app.set_version_flag("--version", &version_text);
  std::function<int()> run;
  add_serve_command(app, run);
  add_plan_command(app, run);
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
  add_gap_benchmark_command(app, run);
  add_terrain_command(app, run);
  add_map_command(app, run);
  add_data_command(app, run);
  add_steps_command(app, run);
  add_validate_command(app, run);
  add_worlds_command(app, run);
  add_catalogue_commands(app, run);
  app.footer(app.get_subcommand("plan")->get_footer());
  refuse_what_is_not_finite(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error);
    return status == 0 ? 0 : 2;
  }
  return run();
}

}  // namespace slipway::server
