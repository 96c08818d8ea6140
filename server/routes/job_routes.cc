#include "server/routes/job_routes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "api/documents/job_document.h"
#include "api/job_kinds.h"
#include "server/routes/job_answers.h"
#include "server/routes/job_events.h"
#include "server/routes/override_routes.h"
#include "server/routes/query.h"
#include "server/routes/request_headers.h"
#include "server/routes/responses.h"

namespace slipway::server {
namespace {

using std::chrono::seconds;

constexpr Threads kHeavy = Threads::kHeavy;

class JobRoutes {
 public:
  JobRoutes(const api::Service& service, api::JobRunner& runner, const RouteOptions& options,
            const std::vector<api::JobKind>& kinds, std::shared_ptr<JobAnswers> answers)
      : service_(service),
        runner_(runner),
        options_(options),
        kinds_(kinds),
        answers_(std::move(answers)),
        events_(runner.store(), [this](const api::Job& job) { return status_of(job); },
                {.admits = options.admits}) {}

  // Records a request without faults, and waits for its end where the client wants that.
  HttpResponse submit(const api::JobKind& kind, const HttpRequest& request) {
    const auto submission = submission_of(request);
    if (!submission) return problem_response(submission.error(), &request);
    auto recorded =
        kind.accept(service_, runner_.store(), {request.principal, request.is_admin}, request.body);
    if (!recorded) return problem_response(recorded.error(), &request);
    const Preferences preferences = preferences_of(request);
    const auto job = runner_.submit(kind.name, *std::move(recorded), *submission);
    if (!job) return problem_response(job.error(), &request);
    seconds wait = preferences.wait.value_or(preferences.respond_async ? seconds(0) : kind.usual_wait);
    wait = std::min(wait, options_.longest_wait);
    HttpResponse response = wait.count() > 0 ? after_waiting(*job, wait, request) : created(*job);
    if (preferences.respond_async && wait.count() == 0) {
      response.headers.emplace_back("Preference-Applied", "respond-async");
    }
    return response;
  }

  HttpResponse get(const HttpRequest& request) {
    const auto job = find_job(runner_.store(), request);
    return job ? job_response(*job, request) : problem_response(job.error(), &request);
  }

  // The same whenever it changes, until the job has ended.
  HttpResponse events(const HttpRequest& request) {
    const auto job = find_job(runner_.store(), request);
    if (!job) return problem_response(job.error(), &request);
    auto stream = events_.open(*job, request);
    return stream ? *std::move(stream) : problem_response(stream.error(), &request);
  }

  HttpResponse list(const HttpRequest& request) {
    constexpr std::size_t kUsuallyListed = 50;
    Query query(request, {"limit", "kind", "state"});
    const std::size_t limit = query.count("limit", kUsuallyListed, options_.most_listed);
    const std::string kind = query.text("kind"), state = query.text("state");
    if (std::vector<std::string_view> known = listed_kinds();
        !kind.empty() && std::find(known.begin(), known.end(), kind) == known.end())
      query.fault("kind", fmt::format("must be one of {}", fmt::join(known, ", ")));
    if (!state.empty() && !api::job_state(state))
      query.fault("state", fmt::format("must be one of {}", fmt::join(api::job_state_names(), ", ")));
    if (const auto error = query.error()) return problem_response(*error, &request);
    const bool all = kind.empty() && state.empty();
    auto jobs = runner_.store().list(all ? limit : options_.most_listed);
    if (!jobs) return problem_response(jobs.error(), &request);
    std::erase_if(*jobs, [&](const api::Job& job) {
      return (!kind.empty() && job.kind != kind) || (!state.empty() && api::describe(job.state) != state);
    });
    if (jobs->size() > limit) jobs->resize(limit);
    HttpResponse response = document(api::json::write_jobs(*jobs));
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  // What the job consists of.
  HttpResponse parts(const HttpRequest& request) {
    const auto job = find_job(runner_.store(), request);
    if (!job) return problem_response(job.error(), &request);
    const auto all = runner_.store().parts(job->id);
    if (!all) return problem_response(all.error(), &request);
    HttpResponse response = document(api::json::write_jobs(*all));
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  HttpResponse dismiss(const HttpRequest& request) {
    const auto known = find_job(runner_.store(), request);
    if (!known) return problem_response(known.error(), &request);
    // What an older program accepted has no owner and is anybody's.
    if (!request.principal.empty() && !known->owner.empty() && !request.is_admin &&
        known->owner != request.principal)
      return problem(ErrorCode::kForbidden, "the job was asked for by somebody else", request);
    const auto job = runner_.dismiss(request.parameter("id"));
    if (!job) return problem_response(job.error(), &request);
    if (!*job) return problem(ErrorCode::kNotFound, "there is no job of this id", request);
    if ((*job)->state != api::JobState::kDismissed) {
      return problem(ErrorCode::kConflict, fmt::format("the job is {} already", api::describe((*job)->state)),
                     request);
    }
    HttpResponse response = document(api::json::write_job(**job, std::nullopt, std::nullopt));
    response.changed_nothing = api::has_ended(known->state);
    return response;
  }

 private:
  std::vector<std::string_view> listed_kinds() const {
    std::vector<std::string_view> names{kOverrideKind};
    for (const api::JobKind& kind : kinds_) names.push_back(kind.name);
    return names;
  }

  HttpResponse created(const api::Job& job) {
    HttpResponse response = document(api::json::write_job(job, std::nullopt, queue_of(job)), 201);
    response.headers.emplace_back("Location", "/v1/jobs/" + job.id);
    if (!api::has_ended(job.state))
      response.headers.emplace_back("Retry-After", std::to_string(kPollSeconds));
    return response;
  }

  HttpResponse after_waiting(const api::Job& accepted, seconds wait, const HttpRequest& request) {
    if (++waiting_ > options_.most_waiting) {
      --waiting_;
      return created(accepted);  // without Preference-Applied: it was not
    }
    const auto job = runner_.wait(accepted.id, wait);
    --waiting_;
    // It is recorded, whatever the store says now: the client must learn where.
    const api::Job known = job && *job ? **job : accepted;
    HttpResponse response = api::has_ended(known.state) ? answers_->of(known, request) : created(known);
    if (api::has_ended(known.state))
      response.headers.emplace_back("Content-Location", "/v1/jobs/" + known.id + "/result");
    response.headers.emplace_back("Preference-Applied", fmt::format("wait={}", wait.count()));
    return response;
  }

  HttpResponse job_response(const api::Job& job, const HttpRequest& request) {
    const std::optional<api::QueueEstimate> queue = queue_of(job);
    // What is before it changes without the job.
    const std::string place = queue ? fmt::format("-{}{}", queue->ahead, queue->shortage ? "-s" : "") : "";
    const std::string tag = fmt::format("\"{}-{}{}\"", job.id, job.version, place);
    // Most polls find nothing new: then nothing is written.
    HttpResponse response = document(is_known_to_client(request, tag) ? "" : status_of(job, queue));
    if (!api::has_ended(job.state))
      response.headers.emplace_back("Retry-After", std::to_string(kPollSeconds));
    return tagged(std::move(response), tag, request);
  }

  std::string status_of(const api::Job& job) { return status_of(job, queue_of(job)); }
  std::string status_of(const api::Job& job, const std::optional<api::QueueEstimate>& queue) {
    std::optional<std::string> failure;
    if (job.state == api::JobState::kFailed) failure = runner_.store().outcome(job.id).value_or(std::nullopt);
    return api::json::write_job(job, failure, queue);
  }

  // Of a job that waits; nothing where it does not, or the store can't say.
  std::optional<api::QueueEstimate> queue_of(const api::Job& job) {
    if (job.state != api::JobState::kAccepted) return std::nullopt;
    return runner_.queue_estimate(job).value_or(std::nullopt);
  }

  const api::Service& service_;
  api::JobRunner& runner_;
  RouteOptions options_;
  const std::vector<api::JobKind>& kinds_;
  std::shared_ptr<JobAnswers> answers_;
  std::atomic<int> waiting_{0};
  JobEvents events_;
};

}  // namespace

std::vector<Route> job_routes(const api::Service& service, api::JobRunner& runner,
                              const RouteOptions& options, const std::vector<api::JobKind>& kinds) {
  const auto answers = std::make_shared<JobAnswers>(service, runner.store(), kinds, options.drawing_folder);
  const auto jobs = std::make_shared<JobRoutes>(service, runner, options, kinds, answers);
  std::vector<Route> routes{
      {"GET", "/v1/jobs", [jobs](const HttpRequest& r) { return jobs->list(r); }},
      {"GET", "/v1/jobs/{id}", [jobs](const HttpRequest& r) { return jobs->get(r); }},
      {"GET", "/v1/jobs/{id}/events", [jobs](const HttpRequest& r) { return jobs->events(r); }},
      {"GET", "/v1/jobs/{id}/parts", [jobs](const HttpRequest& r) { return jobs->parts(r); }},
      {"GET", "/v1/jobs/{id}/answers", [answers](const HttpRequest& r) { return answers->answers(r); },
       kHeavy},
      {"GET", "/v1/jobs/{id}/result", [answers](const HttpRequest& r) { return answers->result(r); }, kHeavy},
      {"GET", "/v1/jobs/{id}/stations", [answers](const HttpRequest& r) { return answers->stations(r); },
       kHeavy},
      {"GET", "/v1/jobs/{id}/map", [answers](const HttpRequest& r) { return answers->map(r); }, kHeavy},
      {"GET", "/v1/jobs/{id}/map.tif", [answers](const HttpRequest& r) { return answers->raster(r); },
       kHeavy},
      {"GET", "/v1/jobs/{id}/vectors.gpkg",
       [answers](const HttpRequest& r) { return answers->vectors(r, true); }, Threads::kDrawn},
      {"GET", "/v1/jobs/{id}/vectors.geojson",
       [answers](const HttpRequest& r) { return answers->vectors(r, false); }, Threads::kDrawn},
      {"GET", "/v1/jobs/{id}/report", [answers](const HttpRequest& r) { return answers->report(r); }, kHeavy},
      {"DELETE", "/v1/jobs/{id}", [jobs](const HttpRequest& r) { return jobs->dismiss(r); }},
  };
  for (const api::JobKind& kind : kinds) {
    routes.push_back({"POST", kind.path,
                      [jobs, &kind](const HttpRequest& r) { return jobs->submit(kind, r); },
                      Threads::kAsking});
    if (kind.has_report)
      routes.push_back({"GET", kind.path + "/{id}/report",
                        [answers](const HttpRequest& r) { return answers->report(r); }, kHeavy});
  }
  return routes;
}

}  // namespace slipway::server
