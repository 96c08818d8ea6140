#pragma once

#include <vector>

#include "api/requests/soil_estimate.h"

namespace slipway::api {

// The tests of a request with the rigs and soils that they name, and the soils that the search starts from.
struct SoilTestRigs {
  gap::SoilData data;
  std::vector<sim::SoilDistribution> nominals;  // one for each of the data's soils
  std::vector<gap::FreeParameter> stated;       // by `set`
};

// Looks up what the request names. What is wrong is added to `faults`: "/soil", "/soils/0/soil", "/rover",
// "/wheels/1/name", "/effects/0", "/set/n@wet", "/free/2". The result is of use where there are none.
SoilTestRigs soil_test_rigs(const Catalogue& catalogue, const SoilEstimateRequest& request,
                            std::vector<Fault>& faults);

}  // namespace slipway::api
