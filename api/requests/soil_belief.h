#pragma once

#include <string>
#include <vector>

#include "api/files/catalogue.h"
#include "api/requests/soil_estimate.h"
#include "core/progress.h"
#include "core/result.h"
#include "gap/estimate/soil_belief.h"

namespace slipway::api {

// The tests of one soil in a file "soil-belief/1".
struct BeliefSoil {
  std::string name;
  SoilEstimateRequest estimate;  // with its tests, and what is free there
};

// Which soils were tested, and what is believed to differ between them.
struct SoilBeliefRequest {
  std::string summary;
  std::vector<BeliefSoil> soils;
  gap::SoilBeliefOptions options;
};

// Errors: invalid_request with the faults of names and numbers ("/soils/0/radius_m"); those of
// gap::believe_soils.
Result<gap::SoilBelief> believe_soils(const Catalogue& catalogue, const SoilBeliefRequest& request,
                                      Progress& progress);

}  // namespace slipway::api
