#pragma once

#include "api/json/writer.h"
#include "api/requests/answers.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::api::json {

// {"value": 0.3, "at_m": 12.5}, the value times `scale`.
void write_peak(Writer& w, std::string_view name, const sim::Peak& peak, double scale = 1.0);

// A predicted drive as members of an open object: its figures ("length_m", "risk", ...).
void write_drive_figures(Writer& w, const sim::DrivePrediction& prediction);

// "stations": one array per quantity, one element per station, and the six wheels likewise.
void write_stations(Writer& w, const sim::DrivePrediction& prediction, const Provenance& provenance);

// "geometry": the stations as a LineString of [x, y, height] in map metres.
void write_line(Writer& w, const sim::DrivePrediction& prediction);

void write_provenance(Writer& w, const Provenance& provenance);

// A share of the draws with its interval.
void write_share(Writer& w, std::string_view name, const sim::DrawnShare& share);

// {"p05": 0.1, "p50": 0.2, "p95": 0.4}: percentiles over the draws.
void write_spread(Writer& w, std::string_view name, const sim::DrawnSpread& spread);

}  // namespace slipway::api::json
