#include "server/routes/operator_routes.h"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "server/routes/responses.h"

namespace slipway::server {
namespace {

HttpResponse metrics(const Operation& of, const HttpRequest& request) {
  const auto jobs = of.store.counts();
  if (!jobs) return problem_response(jobs.error(), &request);
  HttpResponse response;
  response.content_type = "text/plain; version=0.0.4; charset=utf-8";
  response.body = of.metrics.text(of.http(), *jobs);
  return response;
}

HttpResponse readiness(const Operation& of, const HttpRequest& request) {
  if (const auto read = of.store.list(1); !read) return problem_response(read.error(), &request);
  if (const int missing = of.missing_workers(); missing > 0)
    return problem(ErrorCode::kNotReady,
                   fmt::format("{} of the workers {} not run; each is started again", missing,
                               missing == 1 ? "does" : "do"),
                   request);
  HttpResponse response = document(R"({"status":"ready"})");
  response.headers = {{"Cache-Control", "no-store"}};
  return response;
}

}  // namespace

std::vector<Route> operator_routes(const Operation& operation) {
  const auto of = std::make_shared<const Operation>(operation);
  return {{"GET", "/metrics", [of](const HttpRequest& r) { return metrics(*of, r); }},
          {"GET", "/readyz", [of](const HttpRequest& r) { return readiness(*of, r); }}};
}

}  // namespace slipway::server
