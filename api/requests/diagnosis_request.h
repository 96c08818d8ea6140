#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "api/requests/plan_request.h"

namespace slipway::api {

// POST /v1/diagnoses asks which effects these recorded drives show that the simulator lacks.
struct DiagnosisRequest {
  std::string campaign;              // one that the service ships
  std::string reference;             // another one, of the same rover, taken as healthy; empty: none
  std::vector<std::string> without;  // effects that are left out of the search
  std::uint64_t seed = 1;
};

// POST /v1/model-checks asks how well a corrected model predicts drives that it was not made of.
struct ModelCheckRequest {
  std::string campaign;  // of those drives
  // Its `ground`: soils of the campaign that are the model's, where the other campaign called them otherwise.
  std::optional<RequestedModel> model;
  std::uint64_t seed = 1;
};

}  // namespace slipway::api
