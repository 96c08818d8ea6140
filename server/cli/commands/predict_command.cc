#include "server/cli/commands/predict_command.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <vector>

#include "api/json/writer.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/drive_answer.h"
#include "server/cli/inquiry/drive_request.h"
#include "server/cli/terminal/tables.h"

namespace slipway::server {
namespace {

using api::json::Writer;

Result<std::string> prediction_request(const PredictOptions& options) {
  Writer w;
  w.begin_object();
  if (auto written = write_drive(w, options.drive); !written) return fail(written.error());
  w.key("path").begin_array();
  for (const PlaceOption& place : options.path) write_place(w, place);
  w.end_array();
  if (options.backwards) w.boolean("backwards", true);
  if (options.crab_deg) w.exact("crab_deg", *options.crab_deg);
  if (!options.level.empty()) w.text("rung", options.level);
  w.end_object();
  return w.take();
}

}  // namespace

int predict(const PredictOptions& given) {
  const auto rover = models_rover(given.ask, given.drive.rover, !given.request.empty());
  if (!rover) return refuse(rover.error());
  PredictOptions options = given;
  options.drive.rover = *rover;
  // Said before the work is done; of a request in a file its answer says it.
  if (!options.plot.empty() && options.request.empty() && options.level != "dynamic")
    return refuse({ErrorCode::kInvalidRequest,
                   "there is no such plot",
                   {{"/plot", "only a prediction at the dynamic level has a time history: --rung dynamic"}}});
  if (options.drive.lonlat && options.request.empty()) {
    std::vector<PlaceOption*> places;
    for (PlaceOption& place : options.path) places.push_back(&place);
    if (const auto brought = bring_to_map(options.ask, options.drive.terrain, places); !brought)
      return refuse(brought.error());
  }
  if (options.request.empty())
    if (const auto made =
            make_sky(options.ask, options.drive, options.path.empty() ? nullptr : &options.path.front());
        !made)
      return refuse(made.error());
  Pictures pictures = pictures_of(options.drive);
  pictures.history = options.plot;
  return ask_and_print(options.ask, pictures,
                       options.request.empty() ? prediction_request(options) : read_request(options.request),
                       &Inquiry::predict, &prediction_table, &prediction_status,
                       placed_on_command_line(options.drive));
}

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
