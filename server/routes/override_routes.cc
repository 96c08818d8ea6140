#include "server/routes/override_routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "api/job_kind.h"
#include "api/job_kinds.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "core/sha256.h"
#include "core/utc.h"
#include "server/routes/responses.h"

namespace slipway::server {
namespace {

constexpr std::int64_t kConfirmWithin_ms = std::int64_t{10} * 60 * 1000;
constexpr std::size_t kMaxUnconfirmed = 10'000, kMaxUnconfirmedOfOne = 20;
constexpr std::size_t kMinReason = 10, kMaxReason = 2000;

// What somebody has asked for, until it is confirmed.
struct Asked {
  std::string check, reason, by, token;
  std::int64_t at_ms = 0;
};

struct OverrideRequest {
  std::string reason, confirmation;
};

Result<OverrideRequest> read_request(const std::string& body) {
  namespace json = api::json;
  const auto document = json::parse(body, {.bytes = std::size_t{1} << 14U});
  if (!document) return fail(document.error());
  std::vector<Fault> faults;
  OverrideRequest request;
  json::ObjectReader reader(*document, "", faults);
  if (reader.is_object()) {
    if (reader.text("reason", json::kRequired, {.most = kMaxReason}, request.reason) &&
        request.reason.size() < kMinReason)
      faults.push_back({"/reason", fmt::format("must say why, in {} characters or more", kMinReason)});
    reader.text("confirmation", json::kOptional, {.most = 64, .is_name = true}, request.confirmation);
    reader.refuse_unknown();
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, api::summary_of(faults), faults);
  return request;
}

// One check has one override: its job's id follows from the check's.
std::string override_id(const std::string& check) {
  constexpr std::size_t kIdDigits = 32;
  Sha256 hash;
  hash.add("override of " + check);
  return hash.digest().substr(0, kIdDigits);
}

class Overrides {
 public:
  Overrides(api::JobStore& store, const RouteOptions& options)
      : store_(store), persons_(options.override_persons), knows_token_(options.knows_token) {}

  HttpResponse get(const HttpRequest& request) {
    const auto kept = store_.request(override_id(std::string(request.parameter("id"))));
    if (!kept) return problem_response(kept.error(), &request);
    if (!*kept) return problem(ErrorCode::kNotFound, "nobody has overridden this check", request);
    HttpResponse response = document(**kept);
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  HttpResponse post(const HttpRequest& request) {
    const std::string check(request.parameter("id"));
    const auto wanted = read_request(request.body);
    if (!wanted) return problem_response(wanted.error(), &request);
    HttpResponse response = answer_to(check, *wanted, request);
    // The log has the reason whatever became of it, but not what the next person needs to confirm.
    api::json::Writer w;
    w.begin_object().text("override_of", check).text("reason", wanted->reason).end_object();
    if (response.audit.empty()) response.audit = w.take();
    return response;
  }

 private:
  HttpResponse answer_to(const std::string& check, const OverrideRequest& wanted,
                         const HttpRequest& request) {
    const auto verdict = verdict_of(check);
    if (!verdict) return problem_response(verdict.error(), &request);
    if (*verdict == "go")
      return problem(ErrorCode::kConflict, "the check says go: there is nothing to override", request);
    const auto known = store_.get(override_id(check));
    if (!known) return problem_response(known.error(), &request);
    if (*known) return problem(ErrorCode::kConflict, "the check has been overridden already", request);
    return wanted.confirmation.empty() ? ask(check, *verdict, wanted.reason, request)
                                       : confirm(check, *verdict, wanted, request);
  }

  // Of a successful check.
  Result<std::string> verdict_of(const std::string& check) {
    const auto job = store_.get(check);
    if (!job) return fail(job.error());
    if (!*job || (*job)->kind != api::kCheckKind)
      return fail(ErrorCode::kNotFound, "there is no check of this id");
    if ((*job)->state != api::JobState::kSuccessful)
      return fail(ErrorCode::kConflict,
                  fmt::format("the check is {}: it has no verdict", api::describe((*job)->state)));
    const auto outcome = store_.outcome(check);
    if (!outcome) return fail(outcome.error());
    if (!*outcome) return fail(ErrorCode::kNotFound, "the check's result is no longer kept");
    const auto answer = api::json::parse(api::parts_of(**outcome).document,
                                         {.bytes = std::numeric_limits<std::size_t>::max(),
                                          .values = std::numeric_limits<std::size_t>::max()});
    const api::json::JsonValue* const verdict = answer ? answer->find("verdict") : nullptr;
    if (verdict == nullptr || verdict->kind != api::json::JsonValue::Kind::kString)
      return fail(
          ErrorCode::kDamagedStore,
          fmt::format("what is stored of job {} is no check's answer: ask for the check again", check));
    return verdict->text;
  }

  HttpResponse ask(const std::string& check, const std::string& verdict, const std::string& reason,
                   const HttpRequest& request) {
    const std::int64_t now = now_ms();
    const std::string confirmation = api::new_job_id().substr(0, 16);
    {
      const std::scoped_lock lock(mutex_);
      // Who asks again for the same check takes back what was asked before.
      std::erase_if(asked_, [&](const auto& entry) {
        const Asked& a = entry.second;
        return a.at_ms + kConfirmWithin_ms < now || (a.check == check && a.by == request.principal);
      });
      const auto own = static_cast<std::size_t>(std::count_if(
          asked_.begin(), asked_.end(), [&](const auto& a) { return a.second.by == request.principal; }));
      if (own >= kMaxUnconfirmedOfOne)
        return problem(ErrorCode::kOverQuota,
                       fmt::format("{} overrides that you asked for wait for their confirmation: have them "
                                   "confirmed, or wait ten minutes",
                                   own),
                       request);
      if (asked_.size() >= kMaxUnconfirmed)
        return problem(ErrorCode::kTooManyRequests,
                       "too many overrides wait for their confirmation: ask again in ten minutes", request);
      asked_[confirmation] = {check, reason, request.principal, request.token, now};
    }
    api::json::Writer w;
    w.begin_object().text("format", "override/1").text("state", "to_be_confirmed").text("check", check);
    w.text("verdict", verdict).text("reason", reason).text("asked_by", request.principal);
    w.text("confirmation", confirmation)
        .text("confirm_until", utc_text(now + kConfirmWithin_ms))
        .end_object();
    return document(w.take());
  }

  HttpResponse confirm(const std::string& check, const std::string& verdict, const OverrideRequest& wanted,
                       const HttpRequest& request) {
    const std::int64_t now = now_ms();
    std::optional<Asked> asked;
    {
      const std::scoped_lock lock(mutex_);
      const auto found = asked_.find(wanted.confirmation);
      if (found != asked_.end() && found->second.check == check &&
          found->second.at_ms + kConfirmWithin_ms >= now) {
        asked = found->second;
      }
    }
    // What somebody asked for whose token was taken away has lapsed.
    if (asked && !asked->token.empty() && knows_token_ && !knows_token_(asked->token)) asked.reset();
    if (const auto known = store_.get(override_id(check)); !asked && known && *known)
      return problem(ErrorCode::kConflict, "the check has been overridden already", request);
    if (!asked || asked->reason != wanted.reason)
      return problem_response(
          {ErrorCode::kInvalidRequest,
           "The override can't be confirmed.",
           {{asked ? "/reason" : "/confirmation",
             asked ? "must be the one that was asked with"
                   : "is not one that was given for this check within the last ten minutes: ask again "
                     "without it"}}},
          &request);
    // A token is one person's under whatever name.
    const bool is_asker =
        asked->by == request.principal || (!asked->token.empty() && asked->token == request.token);
    if (persons_ > 1 && is_asker)
      return problem(
          ErrorCode::kForbidden,
          fmt::format("{} asked for this override, so another person must confirm it; persons are "
                      "told apart by their tokens (--tokens), and one is enough where the operator "
                      "says --override-persons 1",
                      asked->by),
          request);
    api::json::Writer w;
    w.begin_object().text("format", "override/1").text("state", "overridden").text("check", check);
    w.text("verdict", verdict).text("reason", asked->reason).text("asked_by", asked->by);
    w.text("asked", utc_text(asked->at_ms)).text("confirmed_by", request.principal);
    w.text("confirmed", utc_text(now)).end_object();
    const std::string record = w.take();
    if (const auto kept = keep(check, record, request.principal, now); !kept)
      return problem_response(kept.error(), &request);
    const std::scoped_lock lock(mutex_);
    asked_.erase(wanted.confirmation);
    HttpResponse response = document(record, 201);
    response.headers.emplace_back("Location", "/v1/checks/" + check + "/override");
    response.audit = record;
    return response;
  }

  // As a job that is done at once. It stands once it is accepted; what a process that died left accepted is
  // ended by the next one that comes here.
  Result<void> keep(const std::string& check, const std::string& text, const std::string& owner,
                    std::int64_t now) {
    const api::NewJob job{.id = override_id(check),
                          .kind = std::string(kOverrideKind),
                          .request = text,
                          .owner = owner,
                          .key = "override of " + check};
    const auto accepted = store_.append(job, now, {.most_unfinished = std::numeric_limits<int>::max()});
    if (!accepted) return fail(accepted.error());
    constexpr std::chrono::minutes kLease(1);
    for (;;) {
      const auto term = store_.lease_term(kLease);
      if (!term) return {};
      const auto claimed =
          store_.claim_some("overrides/" + api::new_job_id(), {std::string(kOverrideKind)}, now, *term, 1);
      if (!claimed || claimed->empty()) return {};
      const api::ClaimedJob& record = claimed->front();
      const auto ended =
          store_.finish(record.lease(), api::JobState::kSuccessful, api::JobAnswer(record.request), now);
      if (!ended) return {};
    }
  }

  api::JobStore& store_;
  const int persons_;
  const std::function<bool(const std::string& token)> knows_token_;
  std::mutex mutex_;
  std::map<std::string, Asked, std::less<>> asked_;
};

}  // namespace

std::vector<Route> override_routes(api::JobStore& store, const RouteOptions& options) {
  const auto overrides = std::make_shared<Overrides>(store, options);
  return {
      {"POST", "/v1/checks/{id}/override", [overrides](const HttpRequest& r) { return overrides->post(r); }},
      {"GET", "/v1/checks/{id}/override", [overrides](const HttpRequest& r) { return overrides->get(r); }}};
}

}  // namespace slipway::server
