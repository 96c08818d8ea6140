#pragma once

#include <functional>
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
  std::function<int()> missing_workers = {};  // of the worker processes
};

// /metrics for Prometheus, and /readyz: whether the store answers and every worker runs.
std::vector<Route> operator_routes(const Operation& operation);

}  // namespace slipway::server
