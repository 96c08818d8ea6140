#pragma once

#include <vector>

#include "api/jobs/job_store.h"
#include "server/http/http_routes.h"

namespace slipway::server {

// GET /v1/comparisons?a=JOB&b=JOB: two answers side by side, see api::json::compare_answers. The store must
// outlive the routes.
std::vector<Route> comparison_routes(api::JobStore& store);

}  // namespace slipway::server
