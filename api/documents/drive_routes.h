#pragma once

#include <functional>

#include "api/documents/drive_series.h"
#include "api/json/writer.h"
#include "api/requests/answers.h"

namespace slipway::api::json {

// One route of an answer's GeoJSON: its line, and what else `properties` writes into the feature's
// properties.
struct RouteFeature {
  int id = 1;
  const sim::DrivePrediction& prediction;
  std::vector<std::size_t> shown;  // of its stations
  std::function<void(Writer&)> properties;
};

// "routes": the drives as a FeatureCollection in map metres.
void write_routes(Writer& w, const std::vector<RouteFeature>& routes, const Provenance& provenance);

// "routes" of an answer to one drive: its figures, its stations and, where there is one, its dynamic drive.
void write_route(Writer& w, const sim::DrivePrediction& prediction, const Provenance& provenance,
                 StationDetail detail, const planner::DynamicVerification* dynamic = nullptr);

// The stations of a drive that a document of so many drives shows.
std::vector<std::size_t> stations_in(StationDetail detail, const sim::DrivePrediction& prediction,
                                     std::size_t drives);

}  // namespace slipway::api::json
