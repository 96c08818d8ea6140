#pragma once

#include <cstddef>
#include <vector>

#include "api/json/writer.h"
#include "api/requests/answers.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::api::json {

// {"value": 0.3, "at_m": 12.5}, the value times `scale`.
void write_peak(Writer& w, std::string_view name, const sim::Peak& peak, double scale = 1.0);

// A predicted drive as members of an open object: its figures ("length_m", "risk", ...).
void write_drive_figures(Writer& w, const sim::DrivePrediction& prediction);

// How many stations a document shows: all, or of a long drive so many that what is drawn of it looks the
// same.
enum class StationDetail { kWhole, kThinned };

// How many stations of each of so many drives a thinned document shows at most.
std::size_t max_stations_shown(std::size_t drives);

// The indices of the stations shown, ascending: all where there are no more than `most`; otherwise of each of
// many equal parts of the drive its first station and those with the largest slip, tilt and current, so that
// no peak is lost, and the drive's last.
std::vector<std::size_t> shown_stations(const sim::DrivePrediction& prediction, std::size_t most);

// "stations": one array per quantity, one element per station shown, and the six wheels likewise;
// "thinned_from" says how many there are where not all are shown.
void write_stations(Writer& w, const sim::DrivePrediction& prediction, const Provenance& provenance,
                    const std::vector<std::size_t>& shown);

// "geometry": the stations shown as a LineString of [x, y, height] in map metres.
void write_line(Writer& w, const sim::DrivePrediction& prediction, const std::vector<std::size_t>& shown);

void write_provenance(Writer& w, const Provenance& provenance);

// "broken_limits": a line each, in words.
void write_broken_limits(Writer& w, const std::vector<sim::BrokenLimit>& broken);

// A share of the draws with its interval.
void write_share(Writer& w, std::string_view name, const sim::DrawnShare& share);

// {"p05": 0.1, "p50": 0.2, "p95": 0.4}: percentiles over the draws.
void write_spread(Writer& w, std::string_view name, const sim::DrawnSpread& spread);

}  // namespace slipway::api::json
