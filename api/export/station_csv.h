#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace slipway::api::json {

// The stations of a "check/1", "prediction/1" or "plan/1" document as CSV, one row a station, with the units
// in the header's names; of a plan the first column is the route's rank. A cell is empty where the figure is
// not known, the energy also where the document is thinned. Errors: no_data where the document has no
// stations.
Result<std::string> station_csv(std::string_view document);

// Whether not all stations are in the document.
bool is_thinned(std::string_view document);

// Whether a document has stations: it is an answer to a check, a prediction or a plan.
bool has_stations(std::string_view document);

}  // namespace slipway::api::json
