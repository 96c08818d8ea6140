#include "api/plan_reference.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "api/documents/drive_commands.h"
#include "api/job_kinds.h"
#include "api/json/faults.h"
#include "api/json/laid_over.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/requests/plan_request.h"

namespace slipway::api {
namespace {

tl::unexpected<Error> refused(std::string why) {
  return fail(ErrorCode::kInvalidRequest, why, {{"/plan", why}});
}

// The answer of the plan, or why there is none.
Result<std::string> answer_of(const std::string& id, JobStore& jobs) {
  const auto job = jobs.get(id);
  if (!job) return fail(job.error());
  if (!*job) return refused("there is no job of this id");
  const Job& found = **job;
  if (found.kind != kPlanKind)
    return refused(fmt::format("the job is a {}: only a plan has routes to check", found.kind));
  if (found.state != JobState::kSuccessful)
    return refused(fmt::format("the plan {} {}: it has no routes to check",
                               has_ended(found.state) ? "ended as" : "is", describe(found.state)));
  const auto outcome = jobs.outcome(id);
  if (!outcome) return fail(outcome.error());
  if (!*outcome) return refused("the result of the plan is no longer kept");
  return std::string(parts_of(**outcome).document);
}

// The members but those that name the route.
json::JsonValue others_of(const json::JsonValue& document) {
  json::JsonValue rest;
  rest.kind = json::JsonValue::Kind::kObject;
  for (std::size_t i = 0; i < document.keys.size(); ++i) {
    if (document.keys[i] == "plan" || document.keys[i] == "route") continue;
    rest.keys.push_back(document.keys[i]);
    rest.elements.push_back(document.elements[i]);
  }
  return rest;
}

}  // namespace

Result<std::string> with_plans_route(std::string_view body, JobStore& jobs) {
  const auto document = json::parse(body, {.bytes = RequestLimits::kBodyBytes});
  // What is no document is the reader's to refuse.
  if (!document || document->find("plan") == nullptr) return std::string(body);
  std::vector<Fault> faults;
  json::ObjectReader reader(*document, "", faults);
  std::string id;
  int route = 1;
  reader.text("plan", json::kRequired, {.most = 32, .is_name = true}, id);
  reader.whole("route", json::kOptional, 1, RequestLimits::kRoutes, route);
  for (const std::string_view key : {"path", "start", "commands"})
    if (document->find(key) != nullptr)
      faults.push_back({json::child_pointer("", key), fmt::format("{} and plan exclude each other", key)});
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  const auto answer = answer_of(id, jobs);
  if (!answer) return fail(answer.error());
  const auto plan = json::parse(*answer, {.bytes = answer->size(), .values = answer->size()});
  if (!plan) return fail(ErrorCode::kInternal, "an answer that was kept can't be read");
  const auto check = json::check_of_route(*plan, route);
  if (!check) return fail(check.error());
  const auto base = json::parse(*check, {.bytes = check->size(), .values = check->size()});
  if (!base) return fail(ErrorCode::kInternal, "a route's commands can't be read");
  return json::laid_over(*base, others_of(*document));
}

}  // namespace slipway::api
