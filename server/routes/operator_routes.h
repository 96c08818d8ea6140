#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/jobs/job_store.h"
#include "server/http/http_options.h"
#include "server/http/http_routes.h"
#include "server/operations/metrics.h"

namespace slipway::server {

// What the addresses for those who run the service ask. All of it must outlive the routes.
struct Operation {
  ServiceMetrics& metrics;
  api::JobStore& store;
  std::function<HttpCounters()> http = {};
  std::function<std::optional<std::string>()> not_ready = {};  // why, see Readiness
};

// /metrics for Prometheus, and /readyz: whether the service can take work.
std::vector<Route> operator_routes(const Operation& operation);

}  // namespace slipway::server
