#include "server/job_routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "api/chart/report_page.h"
#include "api/documents/answer_vectors.h"
#include "api/documents/job_document.h"
#include "api/documents/plan_answer.h"
#include "api/documents/station_csv.h"
#include "api/job_kinds.h"
#include "api/json/problem_document.h"
#include "server/drawn_cache.h"
#include "server/job_events.h"
#include "server/query.h"
#include "server/request_headers.h"
#include "server/responses.h"

namespace slipway::server {
namespace {

using std::chrono::seconds;

constexpr std::string_view kCsv = "text/csv";
constexpr std::string_view kGeoJson = "application/geo+json";
constexpr std::string_view kGeoPackage = "application/geopackage+sqlite3";
constexpr std::string_view kCloudOptimised = "image/tiff; application=geotiff; profile=cloud-optimized";
constexpr std::string_view kJsonLines = "application/jsonl";
constexpr std::string_view kHtml = "text/html; charset=utf-8";
constexpr std::string_view kSvg = "image/svg+xml";
constexpr int kPollSeconds = 1;
constexpr std::size_t kDrawnBytes = 16'000'000;  // of pictures and pages that are kept in memory
constexpr bool kHeavy = true;                    // of a Route

class JobRoutes {
 public:
  JobRoutes(const api::Service& service, api::JobRunner& runner, const RouteOptions& options,
            const std::vector<api::JobKind>& kinds)
      : service_(service),
        runner_(runner),
        options_(options),
        kinds_(kinds),
        events_(runner.store(), [this](const api::Job& job) { return status_of(job); }) {}

  // Records a request without faults, and waits for its end where the client wants that.
  HttpResponse submit(const api::JobKind& kind, const HttpRequest& request) {
    const auto submission = submission_of(request);
    if (!submission) return problem_response(submission.error(), &request);
    auto recorded = kind.accept(service_, runner_.store(), request.body);
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
    const auto job = find(request);
    return job ? job_response(*job, request) : problem_response(job.error(), &request);
  }

  // The same whenever it changes, until the job has ended.
  HttpResponse events(const HttpRequest& request) {
    const auto job = find(request);
    if (!job) return problem_response(job.error(), &request);
    auto stream = events_.open(*job, request);
    return stream ? *std::move(stream) : problem_response(stream.error(), &request);
  }

  HttpResponse list(const HttpRequest& request) {
    constexpr std::size_t kUsuallyListed = 50;
    Query query(request, {"limit", "kind", "state"});
    const std::size_t limit = query.count("limit", kUsuallyListed, options_.most_listed);
    const std::string kind = query.text("kind"), state = query.text("state");
    if (!state.empty() && !api::job_state(state)) query.fault("state", "is no state of jobs");
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

  HttpResponse result(const HttpRequest& request) {
    const auto job = find(request);
    if (!job) return problem_response(job.error(), &request);
    return outcome_response(*job, request);
  }

  // All stations of an answer as CSV, page by page.
  HttpResponse stations(const HttpRequest& request) {
    Query query(request, {"page"});
    constexpr std::size_t kMostPages = 1'000'000;
    const auto page = static_cast<std::int64_t>(query.count("page", 1, kMostPages));
    if (const auto error = query.error()) return problem_response(*error, &request);
    const auto job = find(request);
    if (!job) return problem_response(job.error(), &request);
    if (has_file(*job))
      return problem(ErrorCode::kNotFound, fmt::format("jobs of kind {} have no stations", job->kind),
                     request);
    if (job->state != api::JobState::kSuccessful) return outcome_response(*job, request);
    auto table = page_of_stations(*job, page);
    if (!table) return problem_response(table.error(), &request);
    HttpResponse response = document(std::move(table->bytes));
    response.content_type = kCsv;
    if (table->more)
      response.headers.emplace_back(
          "Link", fmt::format("</v1/jobs/{}/stations?page={}>; rel=\"next\"", job->id, page + 1));
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  // What the job consists of.
  HttpResponse parts(const HttpRequest& request) {
    const auto job = find(request);
    if (!job) return problem_response(job.error(), &request);
    const auto all = runner_.store().parts(job->id);
    if (!all) return problem_response(all.error(), &request);
    HttpResponse response = document(api::json::write_jobs(*all));
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  // The answers of a successful batch, one a line.
  HttpResponse answers(const HttpRequest& request) {
    const auto job = find(request);
    if (!job) return problem_response(job.error(), &request);
    const api::JobKind* const kind = api::find_kind(kinds_, job->kind);
    if (kind == nullptr || !kind->has_lines || !job->whole.empty())
      return problem(ErrorCode::kNotFound, fmt::format("jobs of kind {} have one answer", job->kind),
                     request);
    if (job->state != api::JobState::kSuccessful) return outcome_response(*job, request);
    auto lines = whole_series(*job);
    if (!lines) return problem_response(lines.error(), &request);
    HttpResponse response = document(*std::move(lines));
    response.content_type = kJsonLines;
    return tagged(std::move(response), fmt::format("\"{}\"", job->id), request);
  }

  // The raster of a successful job, whole.
  HttpResponse raster(const HttpRequest& request) {
    const auto job = find(request);
    if (!job) return problem_response(job.error(), &request);
    const api::JobKind* const kind = api::find_kind(kinds_, job->kind);
    if (kind == nullptr || !kind->has_raster || !job->whole.empty())
      return problem(ErrorCode::kNotFound, fmt::format("jobs of kind {} have no raster", job->kind), request);
    if (job->state != api::JobState::kSuccessful) return outcome_response(*job, request);
    auto bytes = whole_series(*job);
    if (!bytes) return problem_response(bytes.error(), &request);
    HttpResponse response = document(*std::move(bytes));
    response.content_type = kCloudOptimised;
    response.headers.emplace_back("Content-Disposition",
                                  fmt::format("attachment; filename=\"{}.tif\"", job->id));
    return tagged(std::move(response), fmt::format("\"{}\"", job->id), request);
  }

  // Routes, stations, rules and checks of a successful job for GIS tools.
  HttpResponse vectors(const HttpRequest& request, bool geopackage) {
    Query query(request, {"coordinates"});
    const std::string coordinates = request.query_value("coordinates").value_or("map");
    if (const auto error = query.error()) return problem_response(*error, &request);
    if (coordinates != "map" && (geopackage || coordinates != "lonlat"))
      return problem_response(
          {ErrorCode::kInvalidRequest,
           "The coordinates can't be had.",
           {{"/coordinates", geopackage ? "of a GeoPackage must be map" : "must be map or lonlat"}}},
          &request);
    const auto job = find(request);
    if (!job) return problem_response(job.error(), &request);
    if (job->state != api::JobState::kSuccessful) return outcome_response(*job, request);
    auto bytes = vectors_of(*job, geopackage, coordinates == "lonlat");
    if (!bytes) return problem_response(bytes.error(), &request);
    HttpResponse response = document(*std::move(bytes));
    response.content_type = geopackage ? kGeoPackage : kGeoJson;
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  // The picture of a successful job's answer.
  HttpResponse map(const HttpRequest& request) {
    const auto job = find(request);
    if (!job) return problem_response(job.error(), &request);
    const api::JobKind* const kind = api::find_kind(kinds_, job->kind);
    if (kind == nullptr || !kind->map)
      return problem(ErrorCode::kNotFound, fmt::format("jobs of kind {} have no map", job->kind), request);
    if (job->state != api::JobState::kSuccessful) return outcome_response(*job, request);
    const auto svg = drawn_.get(job->id + "/map", [&]() -> Result<std::string> {
      const auto kept = kept_outcome(*job);
      if (!kept) return fail(kept.error());
      return kind->map(*service_.catalogue(), api::parts_of(*kept).document);
    });
    if (!svg) return problem_response(svg.error(), &request);
    HttpResponse response = document(**svg);
    response.content_type = kSvg;
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  // The report of a successful job, as a page.
  HttpResponse report(const HttpRequest& request) {
    const auto job = find(request);
    if (!job) return problem_response(job.error(), &request);
    const api::JobKind* const kind = api::find_kind(kinds_, job->kind);
    if (kind == nullptr || !kind->has_report)
      return problem(ErrorCode::kNotFound, fmt::format("jobs of kind {} have no report", job->kind), request);
    if (job->state != api::JobState::kSuccessful) return outcome_response(*job, request);
    const auto page = drawn_.get(job->id + "/report", [&]() -> Result<std::string> {
      const auto kept = kept_outcome(*job);
      if (!kept) return fail(kept.error());
      const api::KeptAnswer parts = api::parts_of(*kept);
      if (kind->page) return kind->page(*service_.catalogue(), parts.document);
      if (parts.page.empty()) return fail(ErrorCode::kNotFound, "the job's report is not kept");
      return std::string(parts.page);
    });
    if (!page) return problem_response(page.error(), &request);
    HttpResponse response = document(**page);
    response.content_type = kHtml;
    response.headers.emplace_back("Content-Security-Policy",
                                  fmt::format("{}; frame-ancestors 'self'", api::kReportPolicy));
    response.headers.emplace_back("X-Content-Type-Options", "nosniff");
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  HttpResponse dismiss(const HttpRequest& request) {
    const auto known = find(request);
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
    return document(api::json::write_job(**job, std::nullopt, std::nullopt));
  }

 private:
  // Its series is no table of stations.
  bool has_file(const api::Job& job) const {
    const api::JobKind* const kind = api::find_kind(kinds_, job.kind);
    return kind != nullptr && (kind->has_raster || kind->has_lines);
  }

  // All pages of what is kept apart, put together.
  Result<std::string> whole_series(const api::Job& job) {
    std::string all;
    bool more = true;
    for (std::int64_t page = 1; more; ++page) {
      const auto kept = runner_.store().series(job.id, page);
      if (!kept) return fail(kept.error());
      if (!*kept) return fail(ErrorCode::kNotFound, "the job's result is no longer kept");
      all += (*kept)->bytes;
      more = (*kept)->more;
    }
    return all;
  }

  Result<std::string> vectors_of(const api::Job& job, bool geopackage, bool lonlat) {
    const auto kept = kept_outcome(job);
    if (!kept) return fail(kept.error());
    const std::string answer(api::parts_of(*kept).document);
    if (!api::json::has_stations(answer))
      return fail(ErrorCode::kNotFound, fmt::format("jobs of kind {} have no routes", job.kind));
    const std::shared_ptr<const api::Catalogue> catalogue = service_.catalogue();
    const auto site = catalogue->terrains.find(api::json::terrain_of_answer(answer));
    if (site == catalogue->terrains.end())
      return fail(ErrorCode::kNotFound, "the terrain of the job is no longer among the service's");
    const dem::ElevationInfo& info = site->second->info();
    const api::json::AnswerMap map{info.crs_name, info.crs_wkt, info.body, info.semi_major_axis_m};
    std::string stations;
    if (api::json::is_thinned(answer)) {
      auto all = whole_series(job);
      if (!all) return fail(all.error());
      stations = *std::move(all);
    }
    using api::json::VectorCoordinates;
    if (geopackage) return api::json::answer_geopackage(answer, map, stations);
    return api::json::answer_geojson(
        answer, map, lonlat ? VectorCoordinates::kLongitudeLatitude : VectorCoordinates::kMap, stations);
  }

  // A page of what is kept apart; of an answer that has all its stations, what it has.
  Result<api::SeriesPage> page_of_stations(const api::Job& job, std::int64_t page) {
    auto kept = runner_.store().series(job.id, page);
    if (!kept) return fail(kept.error());
    if (*kept) return **std::move(kept);
    if (page > 1) return fail(ErrorCode::kNotFound, fmt::format("the job's stations have no page {}", page));
    const auto answer = kept_outcome(job);
    if (!answer) return fail(answer.error());
    auto csv = api::json::station_csv(api::parts_of(*answer).document);
    if (!csv) return fail(csv.error());
    return api::SeriesPage{.bytes = *std::move(csv)};
  }

  Result<api::Job> find(const HttpRequest& request) {
    const auto job = runner_.store().get(request.parameter("id"));
    if (!job) return fail(job.error());
    if (!*job) return fail(ErrorCode::kNotFound, "there is no job of this id");
    return **job;
  }

  // What is kept of a job that has ended.
  Result<std::string> kept_outcome(const api::Job& job) {
    auto outcome = runner_.store().outcome(job.id);
    if (!outcome) return fail(std::move(outcome.error()));
    if (!*outcome) return fail(ErrorCode::kNotFound, "the job's result is no longer kept");
    return **std::move(outcome);
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
    HttpResponse response = api::has_ended(known.state) ? outcome_response(known, request) : created(known);
    if (api::has_ended(known.state))
      response.headers.emplace_back("Content-Location", "/v1/jobs/" + known.id + "/result");
    response.headers.emplace_back("Preference-Applied", fmt::format("wait={}", wait.count()));
    return response;
  }

  HttpResponse job_response(const api::Job& job, const HttpRequest& request) {
    const std::optional<api::QueueEstimate> queue = queue_of(job);
    HttpResponse response = document(status_of(job, queue));
    if (!api::has_ended(job.state))
      response.headers.emplace_back("Retry-After", std::to_string(kPollSeconds));
    // What is before it changes without the job.
    const std::string place = queue ? fmt::format("-{}", queue->ahead) : "";
    return tagged(std::move(response), fmt::format("\"{}-{}{}\"", job.id, job.version, place), request);
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

  // The answer of a successful job, the problem of a failed one, the reason why there is neither.
  HttpResponse outcome_response(const api::Job& job, const HttpRequest& request) {
    if (job.state == api::JobState::kDismissed)
      return problem(ErrorCode::kCancelled, "the job was dismissed", request);
    if (!api::has_ended(job.state)) {
      HttpResponse response =
          problem(ErrorCode::kConflict,
                  fmt::format("the job is {}: it has no result yet", api::describe(job.state)), request);
      response.headers.emplace_back("Retry-After", std::to_string(kPollSeconds));
      return response;
    }
    const auto kept = kept_outcome(job);
    if (!kept) return problem_response(kept.error(), &request);
    if (job.state == api::JobState::kFailed) {
      return problem_response(api::json::read_problem(*kept), &request);
    }
    return answer(std::string(api::parts_of(*kept).document), request);
  }

  static HttpResponse answer(const std::string& bytes, const HttpRequest& request) {
    HttpResponse response = document(bytes);
    if (accepts(request, kGeoJson)) {
      auto geojson = api::json::geojson_of(bytes);
      if (!geojson) return problem_response(geojson.error(), &request);
      response.body = std::move(*geojson);
      response.content_type = kGeoJson;
    }
    if (accepts(request, kCsv) && api::json::has_stations(bytes)) {
      auto csv = api::json::station_csv(bytes);
      if (!csv) return problem_response(csv.error(), &request);
      response.body = std::move(*csv);
      response.content_type = kCsv;
    }
    response.headers.emplace_back("Vary", "Accept");
    const std::string tag = tag_of(response.body);
    return request.method == "POST" ? response : tagged(std::move(response), tag, request);
  }

  const api::Service& service_;
  api::JobRunner& runner_;
  RouteOptions options_;
  const std::vector<api::JobKind>& kinds_;
  std::atomic<int> waiting_{0};
  DrawnCache drawn_{kDrawnBytes};
  JobEvents events_;
};

}  // namespace

std::vector<Route> job_routes(const api::Service& service, api::JobRunner& runner,
                              const RouteOptions& options, const std::vector<api::JobKind>& kinds) {
  const auto jobs = std::make_shared<JobRoutes>(service, runner, options, kinds);
  std::vector<Route> routes{
      {"GET", "/v1/jobs", [jobs](const HttpRequest& r) { return jobs->list(r); }},
      {"GET", "/v1/jobs/{id}", [jobs](const HttpRequest& r) { return jobs->get(r); }},
      {"GET", "/v1/jobs/{id}/events", [jobs](const HttpRequest& r) { return jobs->events(r); }},
      {"GET", "/v1/jobs/{id}/parts", [jobs](const HttpRequest& r) { return jobs->parts(r); }},
      {"GET", "/v1/jobs/{id}/answers", [jobs](const HttpRequest& r) { return jobs->answers(r); }, kHeavy},
      {"GET", "/v1/jobs/{id}/result", [jobs](const HttpRequest& r) { return jobs->result(r); }, kHeavy},
      {"GET", "/v1/jobs/{id}/stations", [jobs](const HttpRequest& r) { return jobs->stations(r); }, kHeavy},
      {"GET", "/v1/jobs/{id}/map", [jobs](const HttpRequest& r) { return jobs->map(r); }, kHeavy},
      {"GET", "/v1/jobs/{id}/map.tif", [jobs](const HttpRequest& r) { return jobs->raster(r); }, kHeavy},
      {"GET", "/v1/jobs/{id}/vectors.gpkg", [jobs](const HttpRequest& r) { return jobs->vectors(r, true); },
       kHeavy},
      {"GET", "/v1/jobs/{id}/vectors.geojson",
       [jobs](const HttpRequest& r) { return jobs->vectors(r, false); }, kHeavy},
      {"GET", "/v1/jobs/{id}/report", [jobs](const HttpRequest& r) { return jobs->report(r); }, kHeavy},
      {"DELETE", "/v1/jobs/{id}", [jobs](const HttpRequest& r) { return jobs->dismiss(r); }},
  };
  for (const api::JobKind& kind : kinds) {
    routes.push_back(
        {"POST", kind.path, [jobs, &kind](const HttpRequest& r) { return jobs->submit(kind, r); }});
    if (kind.has_report)
      routes.push_back({"GET", kind.path + "/{id}/report",
                        [jobs](const HttpRequest& r) { return jobs->report(r); }, kHeavy});
  }
  return routes;
}

}  // namespace slipway::server
