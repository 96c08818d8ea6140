#include "server/routes/comparison_routes.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "api/documents/answer_comparison.h"
#include "api/job_kind.h"
#include "server/routes/query.h"
#include "server/routes/responses.h"

namespace slipway::server {
namespace {

// The document of a successful job; a fault at the query's parameter where there is none.
Result<std::string> answer_of(api::JobStore& store, const std::string& id, const std::string& parameter,
                              Query& query) {
  const auto job = store.get(id);
  if (!job) return fail(job.error());
  if (!*job || (*job)->state != api::JobState::kSuccessful) {
    if (!id.empty())
      query.fault(parameter,
                  *job ? fmt::format("the job is {}: it has no answer", api::describe((*job)->state))
                       : "there is no job of this id");
    return {};
  }
  const auto outcome = store.outcome(id);
  if (!outcome) return fail(outcome.error());
  if (!*outcome) return fail(ErrorCode::kNotFound, "a job's result is no longer kept");
  return std::string(api::parts_of(**outcome).document);
}

HttpResponse compare(api::JobStore& store, const HttpRequest& request) {
  Query query(request, {"a", "b", "routes"});
  const std::string ids[] = {query.required_text("a"), query.required_text("b")};
  std::optional<api::json::ComparedRoutes> routes;
  if (request.query_value("routes")) {
    const std::vector<double> ranks = query.required_numbers("routes");
    constexpr double kMaxRank = 1000.0;
    const auto is_rank = [](double r) { return r >= 1.0 && r <= kMaxRank && r == std::floor(r); };
    if (ranks.size() == 2 && is_rank(ranks[0]) && is_rank(ranks[1]))
      routes = {static_cast<int>(ranks[0]), static_cast<int>(ranks[1])};
    else if (!ranks.empty())
      query.fault("routes", "must be two ranks, one of a's routes and one of b's: 1,2");
  }
  const auto a = answer_of(store, ids[0], "a", query);
  if (!a) return problem_response(a.error(), &request);
  const auto b = answer_of(store, ids[1], "b", query);
  if (!b) return problem_response(b.error(), &request);
  if (const auto error = query.error()) return problem_response(*error, &request);
  auto comparison = api::json::compare_answers(*a, *b, routes);
  if (!comparison) return problem_response(comparison.error(), &request);
  HttpResponse response = document(*std::move(comparison));
  const std::string tag = tag_of(response.body);
  return tagged(std::move(response), tag, request);
}

}  // namespace

std::vector<Route> comparison_routes(api::JobStore& store) {
  return {{"GET", "/v1/comparisons", [&store](const HttpRequest& r) { return compare(store, r); },
           Threads::kHeavy}};
}

}  // namespace slipway::server
