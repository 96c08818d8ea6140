#include <CLI/CLI.hpp>
#include <functional>

#include "research/cli/gap_benchmark_command.h"
#include "research/cli/validate_command.h"
#include "research/cli/worlds_command.h"
#include "server/cli/inquiry/command_line.h"
#include "server/cli/inquiry/data_folder.h"

namespace slipway::server {
namespace {

int run_study_command_line(int argc, char** argv) {
  CLI::App app("Slipway's comparisons with published and measured data, and the studies that judge it");
  app.require_subcommand(1);
  app.set_version_flag("--version", &version_text);
  std::function<int()> run;
  add_validate_command(app, run);
  add_worlds_command(app, run);
  add_gap_benchmark_command(app, run);
  return parse_and_run(app, run, argc, argv);
}

}  // namespace
}  // namespace slipway::server

int main(int argc, char** argv) {
  return slipway::server::run_program(argc, argv, &slipway::server::run_study_command_line);
}
