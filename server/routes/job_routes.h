#pragma once

#include <vector>

#include "api/job_kind.h"
#include "api/jobs/job_runner.h"
#include "api/service.h"
#include "server/http/http_routes.h"
#include "server/routes/routes.h"

namespace slipway::server {

// The addresses of jobs: for each kind the one that its requests are posted to, and what all jobs have in
// common (list, state, result, map, report, dismissal). All arguments but the options must outlive the
// routes.
std::vector<Route> job_routes(const api::Service& service, api::JobRunner& runner,
                              const RouteOptions& options, const std::vector<api::JobKind>& kinds);

}  // namespace slipway::server
