#include "server/cli/predict_command.h"

#include <vector>

#include "api/json/writer.h"
#include "server/cli/command_parts.h"
#include "server/cli/drive_answer.h"
#include "server/cli/drive_request.h"
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
  Pictures pictures = pictures_of(options.drive);
  pictures.history = options.plot;
  return ask_and_print(options.ask, pictures,
                       options.request.empty() ? prediction_request(options) : read_request(options.request),
                       &Inquiry::predict, &prediction_table, &prediction_status);
}

}  // namespace slipway::server
