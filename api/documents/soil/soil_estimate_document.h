#pragma once

#include <string>

#include "api/requests/soil_estimate.h"

namespace slipway::api::json {

// "soil-estimate/1": of each soil what the data determine and how well, what is left over, and the soil to
// plan with. The same estimate gives the same bytes; units are those of the boundary.
std::string soil_estimate_document(const SoilEstimateAnswer& answer);

// A soils' file of the estimated soils, for data/soils.
std::string estimated_soils_document(const SoilEstimateAnswer& answer);

}  // namespace slipway::api::json
