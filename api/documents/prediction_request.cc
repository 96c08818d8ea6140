#include "api/documents/prediction_request.h"

#include "api/documents/drive_assumptions.h"
#include "api/documents/zones.h"
#include "api/json/parse.h"

namespace slipway::api::json {
namespace {

// In the order of Rung.
const std::vector<std::string_view> kLevels{"quasi_static", "dynamic"};

}  // namespace

Result<Reading<PredictionRequest>> read_prediction_request(std::string_view bytes) {
  const auto document = parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  Reading<PredictionRequest> reading;
  PredictionRequest& request = reading.request;
  ObjectReader reader(*document, "", reading.faults);
  if (!reader.is_object()) return reading;
  read_names(reader, request.terrain, request.rover);
  const std::size_t least = document->find("drive_so_far") != nullptr ? 1 : 2;
  for (const Element& element : reader.list("path", kRequired, {least, RequestLimits::kPathCorners})) {
    read_waypoint(*element.value, element.pointer, request.path.emplace_back(), reading.faults);
  }
  reader.boolean("backwards", kOptional, request.manner.backwards);
  reader.angle_deg("crab_deg", kOptional, {"deg", -90.0, 90.0}, request.manner.crab_rad);
  std::size_t level = 0;
  if (reader.choice("rung", kOptional, kLevels, level)) request.level = static_cast<FidelityLevel>(level);
  read_zones(reader, request.keep_out, request.keep_in, reading.faults);
  read_drive_assumptions(reader, request.drive);
  go_on_from_place_reached(request.drive, request.path);
  reader.refuse_unknown();
  return reading;
}

std::string write_prediction_request(const PredictionRequest& request) {
  Writer w;
  w.begin_object();
  w.text("terrain", request.terrain).text("rover", request.rover);
  w.key("path").begin_array();
  for (const planner::Waypoint& corner : request.path) write_waypoint(w, corner);
  w.end_array();
  w.boolean("backwards", request.manner.backwards).angle_deg("crab_deg", request.manner.crab_rad);
  w.text("rung", kLevels[static_cast<std::size_t>(request.level)]);
  if (!request.keep_out.empty() || !request.keep_in.empty())
    write_zones(w, request.keep_out, request.keep_in);
  write_drive_assumptions(w, request.drive);
  w.end_object();
  return w.take();
}

}  // namespace slipway::api::json
