#include "server/routes/operator_routes.h"

#include <memory>
#include <string>
#include <utility>

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
  if (auto reason = of.not_ready()) return problem(ErrorCode::kNotReady, *std::move(reason), request);
  HttpResponse response = document(R"({"status":"ready"})");
  response.headers = {{"Cache-Control", "no-store"}};
  return response;
}

}  // namespace

std::vector<Route> operator_routes(const Operation& operation) {
  const auto of = std::make_shared<const Operation>(operation);
  return {{"GET", "/metrics", [of](const HttpRequest& r) { return metrics(*of, r); }},
          {.method = "GET",
           .pattern = "/readyz",
           .handle = [of](const HttpRequest& r) { return readiness(*of, r); },
           .threads = Threads::kPrompt}};
}

}  // namespace slipway::server
