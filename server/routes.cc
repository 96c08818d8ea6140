#include "server/routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "api/chart/report_page.h"
#include "api/documents/catalogue_documents.h"
#include "api/documents/job_document.h"
#include "api/documents/plan_answer.h"
#include "api/documents/wheel_sweep_answer.h"
#include "api/job_kinds.h"
#include "api/json/faults.h"
#include "api/json/problem_document.h"
#include "api/model_reference.h"
#include "api/openapi.h"
#include "api/report/route_map.h"
#include "api/wheel_sweep.h"

namespace slipway::server {
namespace {

using std::chrono::seconds;

constexpr std::string_view kJson = "application/json";
constexpr std::string_view kGeoJson = "application/geo+json";
constexpr std::string_view kCsv = "text/csv";
constexpr std::string_view kHtml = "text/html; charset=utf-8";
constexpr int kPollSeconds = 1;

HttpResponse document(std::string body, int status = 200) {
  HttpResponse response;
  response.status = status;
  response.content_type = kJson;
  response.body = std::move(body);
  response.headers.emplace_back("Cache-Control", "no-cache");
  return response;
}

HttpResponse problem(ErrorCode code, std::string detail, const HttpRequest& request) {
  return problem_response(Error{code, std::move(detail), {}}, &request);
}

// FNV-1a over the bytes: the same document has the same tag on every machine.
std::string tag_of(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return fmt::format("\"{:016x}\"", hash);
}

// Calls visit(item) for every item of a header's comma-separated list, over all its lines, without blanks
// around.
template <class Visit>
void for_each_item(const HttpRequest& request, std::string_view header, const Visit& visit) {
  for (const auto& [name, value] : request.headers) {
    if (!equal_ignoring_case(name, header)) continue;
    std::string_view rest = value;
    while (!rest.empty()) {
      const std::size_t comma = rest.find(',');
      std::string_view item = rest.substr(0, comma);
      rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
      const std::size_t first = item.find_first_not_of(" \t");
      if (first == std::string_view::npos) continue;
      visit(item.substr(first, item.find_last_not_of(" \t") - first + 1));
    }
  }
}

// Whether the client names this media type.
bool accepts(const HttpRequest& request, std::string_view type) {
  bool wanted = false;
  for_each_item(request, "Accept", [&](std::string_view item) {
    wanted = wanted || equal_ignoring_case(item.substr(0, item.find(';')), type);
  });
  return wanted;
}

bool is_known_to_client(const HttpRequest& request, std::string_view tag) {
  bool known = false;
  for_each_item(request, "If-None-Match", [&](std::string_view item) {
    if (item.starts_with("W/")) item.remove_prefix(2);
    known = known || item == "*" || item == tag;
  });
  return known;
}

// Adds the tag, and answers 304 to who has this version already.
HttpResponse tagged(HttpResponse response, const std::string& tag, const HttpRequest& request) {
  response.headers.emplace_back("ETag", tag);
  if (is_known_to_client(request, tag)) {
    response.status = 304;
    response.body.clear();
    response.content_type.clear();
  }
  return response;
}

// RFC 7240; what is malformed or not known is ignored, as it says.
struct Preferences {
  std::optional<seconds> wait;
  bool respond_async = false;
};

Preferences preferences_of(const HttpRequest& request) {
  Preferences preferences;
  for_each_item(request, "Prefer", [&](std::string_view item) {
    item = item.substr(0, item.find(';'));  // parameters of a preference: none of ours has any
    item = item.substr(0, item.find_last_not_of(" \t") + 1);
    if (equal_ignoring_case(item, "respond-async")) preferences.respond_async = true;
    constexpr std::string_view kWait = "wait=";
    if (preferences.wait || item.size() <= kWait.size() ||
        !equal_ignoring_case(item.substr(0, kWait.size()), kWait)) {
      return;
    }
    item.remove_prefix(kWait.size());
    if (item.size() > 2 && item.front() == '"' && item.back() == '"') item = item.substr(1, item.size() - 2);
    int value = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), value);
    if (error == std::errc() && end == item.data() + item.size() && value >= 0)
      preferences.wait = seconds(value);
  });
  return preferences;
}

// GET of a document that never changes while the program runs.
Route fixed(std::string pattern, std::string body) {
  auto shared = std::make_shared<const std::string>(std::move(body));
  const std::string tag = tag_of(*shared);
  return {"GET", std::move(pattern),
          [shared, tag](const HttpRequest& request) { return tagged(document(*shared), tag, request); }};
}

// A query that has these parameters, each once, and no others.
class Query {
 public:
  Query(const HttpRequest& request, std::vector<std::string> known) : request_(request) {
    for (const auto& [name, value] : request.query) {
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        faults_.push_back({"/" + name, api::unknown_name("query parameter", name, known)});
      } else if (std::count_if(request.query.begin(), request.query.end(),
                               [&n = name](const auto& entry) { return entry.first == n; }) > 1) {
        faults_.push_back({"/" + name, fmt::format("{} is given more than once", name)});
      }
    }
  }

  double required_number(const std::string& name) {
    const auto text = request_.query_value(name);
    double value = 0.0;
    if (!text) {
      faults_.push_back({"/" + name, fmt::format("{} is missing", name)});
    } else if (!read(*text, value) || !std::isfinite(value)) {
      faults_.push_back({"/" + name, fmt::format("{} = {}, must be a number", name, api::in_quotes(*text))});
    }
    return value;
  }

  std::size_t count(const std::string& name, std::size_t initial, std::size_t most) {
    const auto text = request_.query_value(name);
    std::size_t value = initial;
    if (text && (!read(*text, value) || value < 1 || value > most)) {
      faults_.push_back({"/" + name, fmt::format("{} = {}, must be a whole number in [1, {}]", name,
                                                 api::in_quotes(*text), most)});
    }
    return value;
  }

  std::optional<Error> error() const {
    if (faults_.empty()) return std::nullopt;
    return Error{ErrorCode::kInvalidRequest, api::summary_of(faults_), faults_};
  }

 private:
  template <class Number>
  static bool read(const std::string& text, Number& out) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    return error == std::errc() && end == text.data() + text.size();
  }

  const HttpRequest& request_;
  std::vector<Fault> faults_;
};

class JobRoutes {
 public:
  JobRoutes(api::JobRunner& runner, const RouteOptions& options) : runner_(runner), options_(options) {}

  // Records the request, which was read without faults, and waits for its end where the client wants that.
  HttpResponse submit(std::string_view kind, const HttpRequest& request, seconds usual_wait) {
    return submit(kind, request, request.body, usual_wait);
  }

  // A plan or a prediction, which may name the model of a diagnosis.
  HttpResponse submit_drive(std::string_view kind, const HttpRequest& request, seconds usual_wait,
                            const api::RequestFaults& faults_of) {
    const auto recorded = api::recordable_request(request.body, runner_.store(), faults_of);
    return recorded ? submit(kind, request, *recorded, usual_wait)
                    : problem_response(recorded.error(), &request);
  }

  HttpResponse submit(std::string_view kind, const HttpRequest& request, const std::string& recorded,
                      seconds usual_wait) {
    const Preferences preferences = preferences_of(request);
    const auto job = runner_.submit(std::string(kind), recorded);
    if (!job) return problem_response(job.error(), &request);
    seconds wait = preferences.wait.value_or(preferences.respond_async ? seconds(0) : usual_wait);
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

  HttpResponse list(const HttpRequest& request) {
    constexpr std::size_t kUsuallyListed = 50;
    Query query(request, {"limit"});
    const std::size_t limit = query.count("limit", kUsuallyListed, options_.most_listed);
    if (const auto error = query.error()) return problem_response(*error, &request);
    const auto jobs = runner_.store().list(limit);
    if (!jobs) return problem_response(jobs.error(), &request);
    HttpResponse response = document(api::json::write_jobs(*jobs));
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  HttpResponse result(const HttpRequest& request) {
    const auto job = find(request);
    if (!job) return problem_response(job.error(), &request);
    return outcome_response(*job, request);
  }

  // The picture of a successful job's routes.
  HttpResponse map(const api::Service& service, const HttpRequest& request) {
    const auto job = find(request);
    if (!job) return problem_response(job.error(), &request);
    if (job->kind == api::kDiagnosisKind || job->kind == api::kSoilEstimateKind)
      return problem(ErrorCode::kNotFound, "a diagnosis and a soil estimate have no map of routes", request);
    if (job->state != api::JobState::kSuccessful) return outcome_response(*job, request);
    const auto outcome = runner_.store().outcome(job->id);
    if (!outcome) return problem_response(outcome.error(), &request);
    if (!*outcome) return problem(ErrorCode::kNotFound, "the job's result is no longer kept", request);
    const auto svg = api::draw_route_map(service.catalogue(), **outcome);
    if (!svg) return problem_response(svg.error(), &request);
    HttpResponse response = document(*svg);
    response.content_type = "image/svg+xml";
    return response;
  }

  // The report of a successful diagnosis, as a page.
  HttpResponse report(const HttpRequest& request) {
    const auto job = find(request);
    if (!job) return problem_response(job.error(), &request);
    if (job->kind != api::kDiagnosisKind)
      return problem(ErrorCode::kNotFound, "only a diagnosis has a report", request);
    if (job->state != api::JobState::kSuccessful) return outcome_response(*job, request);
    const auto outcome = runner_.store().outcome(job->id);
    if (!outcome) return problem_response(outcome.error(), &request);
    const std::string_view page = *outcome ? api::parts_of(**outcome).page : std::string_view();
    if (page.empty()) return problem(ErrorCode::kNotFound, "the diagnosis's report is not kept", request);
    HttpResponse response = document(std::string(page));
    response.content_type = kHtml;
    response.headers.emplace_back("Content-Security-Policy",
                                  fmt::format("{}; frame-ancestors 'self'", api::kReportPolicy));
    response.headers.emplace_back("X-Content-Type-Options", "nosniff");
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  HttpResponse dismiss(const HttpRequest& request) {
    const auto job = runner_.dismiss(request.parameter("id"));
    if (!job) return problem_response(job.error(), &request);
    if (!*job) return problem(ErrorCode::kNotFound, "there is no job of this id", request);
    if ((*job)->state != api::JobState::kDismissed) {
      return problem(ErrorCode::kConflict, fmt::format("the job is {} already", api::describe((*job)->state)),
                     request);
    }
    return document(api::json::write_job(**job, std::nullopt));
  }

 private:
  Result<api::Job> find(const HttpRequest& request) {
    const auto job = runner_.store().get(request.parameter("id"));
    if (!job) return fail(job.error());
    if (!*job) return fail(ErrorCode::kNotFound, "there is no job of this id");
    return **job;
  }

  HttpResponse created(const api::Job& job) {
    HttpResponse response = document(api::json::write_job(job, std::nullopt), 201);
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
    std::optional<std::string> failure;
    if (job.state == api::JobState::kFailed) failure = runner_.store().outcome(job.id).value_or(std::nullopt);
    HttpResponse response = document(api::json::write_job(job, failure));
    if (!api::has_ended(job.state))
      response.headers.emplace_back("Retry-After", std::to_string(kPollSeconds));
    return tagged(std::move(response), fmt::format("\"{}-{}\"", job.id, job.version), request);
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
    const auto outcome = runner_.store().outcome(job.id);
    if (!outcome) return problem_response(outcome.error(), &request);
    if (!*outcome) return problem(ErrorCode::kNotFound, "the job's result is no longer kept", request);
    if (job.state == api::JobState::kFailed) {
      return problem_response(api::json::read_problem(**outcome), &request);
    }
    return answer(std::string(api::parts_of(**outcome).document), request);
  }

  static HttpResponse answer(const std::string& bytes, const HttpRequest& request) {
    HttpResponse response = document(bytes);
    if (accepts(request, kGeoJson)) {
      auto geojson = api::json::geojson_of(bytes);
      if (!geojson) return problem_response(geojson.error(), &request);
      response.body = std::move(*geojson);
      response.content_type = kGeoJson;
    }
    response.headers.emplace_back("Vary", "Accept");
    const std::string tag = tag_of(response.body);
    return request.method == "POST" ? response : tagged(std::move(response), tag, request);
  }

  api::JobRunner& runner_;
  RouteOptions options_;
  std::atomic<int> waiting_{0};
};

template <class Request>
std::optional<Error> error_of(const Result<Request>& reading) {
  return reading ? std::nullopt : std::optional<Error>(reading.error());
}

// Answered at once: the rows are few enough.
HttpResponse wheel_sweep(const api::Service& service, const HttpRequest& request) {
  const auto answer = api::run_wheel_sweep(service.catalogue(), request.body);
  if (!answer) return problem_response(answer.error(), &request);
  HttpResponse response = document(api::json::write_wheel_sweep_answer(*answer));
  if (accepts(request, kCsv)) {
    auto csv = api::json::wheel_sweep_csv(response.body);
    if (!csv) return problem_response(csv.error(), &request);
    response.body = std::move(*csv);
    response.content_type = kCsv;
  }
  response.headers.emplace_back("Vary", "Accept");
  return response;
}

HttpResponse ground_at(const api::Service& service, const HttpRequest& request) {
  Query query(request, {"x_m", "y_m"});
  const double x_m = query.required_number("x_m");
  const double y_m = query.required_number("y_m");
  if (const auto error = query.error()) return problem_response(*error, &request);
  const auto at = service.ground_at(request.parameter("name"), x_m, y_m);
  return at ? document(api::json::write_ground_at(*at)) : problem_response(at.error(), &request);
}

}  // namespace

HttpResponse problem_response(const Error& error, const HttpRequest* /*request*/) {
  const ErrorRow& row = error_row(error.code);
  HttpResponse response;
  response.status = row.http_status;
  response.content_type = "application/problem+json";
  response.body = api::json::write_problem(error);
  response.headers.emplace_back("Cache-Control", "no-store");
  constexpr int kUnavailable = 503;
  constexpr int kRetrySeconds = 5;
  if (row.http_status == kUnavailable)
    response.headers.emplace_back("Retry-After", std::to_string(kRetrySeconds));
  return response;
}

std::vector<Route> api_routes(const api::Service& service, api::JobRunner& runner,
                              const RouteOptions& options) {
  const auto jobs = std::make_shared<JobRoutes>(runner, options);
  const api::Catalogue& catalogue = service.catalogue();
  return {
      fixed("/healthz", api::json::write_health()),
      fixed("/openapi.json", std::string(api::openapi_document())),
      fixed("/errors", api::json::write_errors()),
      fixed("/v1/terrains", api::json::write_terrains(catalogue)),
      fixed("/v1/rovers", api::json::write_rovers(catalogue)),
      fixed("/v1/soils", api::json::write_soils(catalogue)),
      fixed("/v1/effects", api::json::write_effects()),
      fixed("/v1/planners", api::json::write_planners(service.planners(), service.costs())),
      fixed("/v1/drive-campaigns", api::json::write_drive_campaigns(service.campaigns())),
      {"GET", "/v1/terrains/{name}/point",
       [&service](const HttpRequest& r) { return ground_at(service, r); }},
      {"POST", "/v1/plans",
       [&service, jobs](const HttpRequest& r) {
         return jobs->submit_drive(api::kPlanKind, r, seconds(0), [&service](std::string_view body) {
           return error_of(service.read_plan(body));
         });
       }},
      {"POST", "/v1/predictions",
       [&service, jobs, wait = options.prediction_wait](const HttpRequest& r) {
         return jobs->submit_drive(api::kPredictionKind, r, wait, [&service](std::string_view body) {
           return error_of(service.read_prediction(body));
         });
       }},
      {"POST", "/v1/diagnoses",
       [&service, jobs](const HttpRequest& r) {
         const auto request = service.read_diagnosis(r.body);
         return request ? jobs->submit(api::kDiagnosisKind, r, seconds(0))
                        : problem_response(request.error(), &r);
       }},
      {"POST", "/v1/soil-estimates",
       [&service, jobs](const HttpRequest& r) {
         const auto request = service.read_soil_estimate(r.body);
         return request ? jobs->submit(api::kSoilEstimateKind, r, seconds(0))
                        : problem_response(request.error(), &r);
       }},
      {"POST", "/v1/wheel-sweeps", [&service](const HttpRequest& r) { return wheel_sweep(service, r); }},
      {"GET", "/v1/jobs", [jobs](const HttpRequest& r) { return jobs->list(r); }},
      {"GET", "/v1/jobs/{id}", [jobs](const HttpRequest& r) { return jobs->get(r); }},
      {"GET", "/v1/jobs/{id}/result", [jobs](const HttpRequest& r) { return jobs->result(r); }},
      {"GET", "/v1/jobs/{id}/map", [&service, jobs](const HttpRequest& r) { return jobs->map(service, r); }},
      {"GET", "/v1/jobs/{id}/report", [jobs](const HttpRequest& r) { return jobs->report(r); }},
      {"GET", "/v1/diagnoses/{id}/report", [jobs](const HttpRequest& r) { return jobs->report(r); }},
      {"DELETE", "/v1/jobs/{id}", [jobs](const HttpRequest& r) { return jobs->dismiss(r); }},
  };
}

}  // namespace slipway::server
