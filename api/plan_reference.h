#pragma once

#include <string>
#include <string_view>

#include "api/jobs/job_store.h"
#include "core/result.h"

namespace slipway::api {

// The body of a check as its kind reads it: where it names a route of a plan, {"plan": JOB, "route": 2} (1
// where none is named), it is the request of a check of that route's commands under all that the plan
// assumes, with the body's other members laid over it. Others stay as they came, byte by byte. Errors:
// invalid_request at /plan and /route; storage.
Result<std::string> with_plans_route(std::string_view body, JobStore& jobs);

}  // namespace slipway::api
