#pragma once

#include <string_view>

#include "api/requests/sol_answer.h"
#include "api/service.h"
#include "core/progress.h"

namespace slipway::api {

// The request of a plan that says when the drive may begin. Errors: as read_plan(); invalid_request where it
// does not.
Result<PlanRequest> read_sol(const Service& service, std::string_view json);

Result<SolAnswer> run_sol(const Service& service, const PlanRequest& request, Progress& progress);

}  // namespace slipway::api
