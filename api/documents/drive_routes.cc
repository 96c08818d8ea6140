#include "api/documents/drive_routes.h"

#include "api/documents/drive_series.h"
#include "api/documents/dynamic_series.h"

namespace slipway::api::json {

void write_routes(Writer& w, const std::vector<RouteFeature>& routes, const Provenance& provenance) {
  // Map metres, not degrees of the Earth: RFC 7946 section 4 asks for a prior arrangement, and crs_name says
  // it.
  w.key("routes").begin_object().text("type", "FeatureCollection").text("crs_name", provenance.crs_name);
  w.text("coordinates", "x_m, y_m, height_m in the terrain's projected system");
  w.key("features").begin_array();
  for (const RouteFeature& route : routes) {
    w.begin_object().text("type", "Feature").whole("id", route.id);
    write_line(w, route.prediction, route.shown);
    w.key("properties").begin_object();
    route.properties(w);
    w.end_object().end_object();
  }
  w.end_array().end_object();
}

void write_route(Writer& w, const sim::DrivePrediction& prediction, const Provenance& provenance,
                 StationDetail detail, const planner::DynamicVerification* dynamic) {
  const std::vector<std::size_t> shown = stations_in(detail, prediction, 1);
  const auto properties = [&](Writer& of) {
    write_drive_figures(of, prediction);
    write_stations(of, prediction, provenance, shown);
    if (dynamic != nullptr) write_dynamic_drive(of, *dynamic);
  };
  write_routes(w, {{.id = 1, .prediction = prediction, .shown = shown, .properties = properties}},
               provenance);
}

std::vector<std::size_t> stations_in(StationDetail detail, const sim::DrivePrediction& prediction,
                                     std::size_t drives) {
  const bool whole = detail == StationDetail::kWhole;
  return shown_stations(prediction, whole ? prediction.stations.size() : max_stations_shown(drives));
}

}  // namespace slipway::api::json
