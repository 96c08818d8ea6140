#pragma once

#include <string>

#include "api/requests/sol_answer.h"

namespace slipway::api::json {

// "sol/1": the verdict with its reasons, the places that matter, the plan whole and the check of the way
// back.
std::string write_sol(const SolAnswer& answer);

}  // namespace slipway::api::json
