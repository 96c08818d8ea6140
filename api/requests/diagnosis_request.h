#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace slipway::api {

// POST /v1/diagnoses asks which effects these recorded drives show that the simulator lacks.
struct DiagnosisRequest {
  std::string campaign;              // one that the service ships
  std::string reference;             // another one, of the same rover, taken as healthy; empty: none
  std::vector<std::string> without;  // effects that are left out of the search
  std::uint64_t seed = 1;
};

}  // namespace slipway::api
