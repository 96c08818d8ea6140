#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "api/jobs/job_runner.h"
#include "api/service.h"
#include "server/http/http_message.h"
#include "server/http/http_routes.h"

namespace slipway::server {

struct RouteOptions {
  std::chrono::seconds longest_wait{30};     // a longer "Prefer: wait" is cut to this
  std::chrono::seconds prediction_wait{10};  // a prediction is short: its client waits unless it asks not to
  int most_waiting = 4;                      // waiting clients hold a handler's thread each: keep some free
  std::size_t most_listed = 500;
};

// What is asked and answered under which address. The service and the runner must outlive the routes.
std::vector<Route> api_routes(const api::Service& service, api::JobRunner& runner,
                              const RouteOptions& options = {});

// An error as application/problem+json, with the headers that go with it. The request may be null.
HttpResponse problem_response(const Error& error, const HttpRequest* request);

}  // namespace slipway::server
