#include "server/operations/metrics.h"

#include <gtest/gtest.h>

namespace slipway::server {
namespace {

TEST(ServiceMetrics, CountWhatTheyAreTold) {
  ServiceMetrics metrics;
  HttpRequest poll, stranger;
  poll.method = stranger.method = "GET";
  poll.route = "/v1/jobs/{id}";
  HttpResponse good, bad;
  bad.status = 404;
  for (int k = 0; k < 3; ++k) metrics.count_answer({poll, good, 0.002});
  metrics.count_answer({stranger, bad, 0.0001});
  metrics.count_worker_death();
  const auto has = [](const std::string& text, const std::string& line) {
    EXPECT_NE(text.find(line + "\n"), std::string::npos) << line << "\n" << text;
  };
  const std::string text =
      metrics.text({.open_connections = 5, .requests_refused = 7}, {{"plan", api::JobState::kAccepted, 2}});
  has(text, R"(slipway_http_requests_total{method="GET",route="/v1/jobs/{id}",status="200"} 3)");
  has(text, R"(slipway_http_requests_total{method="GET",route="none",status="404"} 1)");
  has(text, R"(slipway_http_request_duration_seconds_count{route="/v1/jobs/{id}"} 3)");
  has(text, R"(slipway_http_request_duration_seconds_bucket{route="/v1/jobs/{id}",le="0.001"} 0)");
  has(text, R"(slipway_http_request_duration_seconds_bucket{route="/v1/jobs/{id}",le="0.0025"} 3)");
  has(text, "slipway_http_connections 5");
  has(text, R"(slipway_http_refused_total{what="requests"} 7)");
  has(text, R"(slipway_jobs{kind="plan",state="accepted"} 2)");
  has(text, "slipway_worker_deaths_total 1");
  const std::string later =
      metrics.text({.requests_refused = 9, .requests_abandoned = 4}, {{"plan", api::JobState::kRunning, 1}});
  has(later, R"(slipway_jobs{kind="plan",state="accepted"} 0)");
  has(later, R"(slipway_jobs{kind="plan",state="running"} 1)");
  has(later, R"(slipway_http_refused_total{what="requests"} 9)");
  has(later, R"(slipway_http_refused_total{what="abandoned"} 4)");
}

}  // namespace
}  // namespace slipway::server
