#pragma once

#include <string_view>

#include "api/json/strict_reader.h"
#include "api/requests/plan_request.h"
#include "api/requests/soil_estimate.h"
#include "core/result.h"

namespace slipway::api::json {

// Errors only where the bytes are no JSON document; everything else is a fault in the reading. Whether there
// are such a soil, rover and campaign is the service's to say.
Result<Reading<SoilEstimateRequest>> read_soil_estimate_request(std::string_view bytes);

// How the slips of a request's tests are meant.
struct SlipOfTests {
  sim::SlipDefinition definition = sim::SlipDefinition::kForward;
  sim::SlipRadius radius = sim::SlipRadius::kRim;
};

// Reads such a request's object, which may stand in another document; faults go to the reader.
SlipOfTests read_soil_estimate(ObjectReader& reader, SoilEstimateRequest& request);

}  // namespace slipway::api::json
