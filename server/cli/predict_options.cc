#include <CLI/CLI.hpp>
#include <memory>

#include "server/cli/predict_command.h"

namespace slipway::server {
namespace {

constexpr const char* kPredictExample =
    "Example: what the wheels do on a given path\n"
    "  slipway predict --path 8142579.7,-276648.7 8142578,-276680 8142566.4,-276711.7 --effect "
    "slip_sinkage:n1=0.2";

}  // namespace

void add_predict_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<PredictOptions>();
  CLI::App* command = app.add_subcommand("predict", "simulate a given path");
  add_ask(*command, options->ask);
  add_why(*command, options->ask);
  add_model(*command, options->ask);
  add_drive(*command, options->drive);
  add_places(*command, "--path", options->path, "corners of the path, each x,y or x,y,yaw_deg");
  command->add_flag("--backwards", options->backwards, "drive the path backwards");
  command->add_option("--crab-deg", options->crab_deg,
                      "direction of travel from the body's axis, positive to the left");
  command->add_option("--rung", options->level,
                      "quasi_static, or dynamic: drive the path as a multibody too");
  command->add_option("--plot", options->plot,
                      "write the time history of the dynamic drive (SVG) to this file; needs that level");
  command->add_option("--request", options->request,
                      "file with a whole request, - for standard input; other options are not used");
  command->footer(kPredictExample);
  command->callback([options, &run] { run = [options] { return predict(*options); }; });
}

}  // namespace slipway::server
