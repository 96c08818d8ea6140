#include <fmt/format.h>

#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <system_error>

#include "api/files/file_lock.h"
#include "api/job_kinds.h"
#include "api/jobs/job_runner.h"
#include "api/jobs/open_job_store.h"
#include "api/service.h"
#include "core/utc.h"
#include "core/version.h"
#include "server/cli/commands/serve_command.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/terminal/tables.h"
#include "server/http/http_cross_origin.h"
#include "server/http/http_host.h"
#include "server/http/http_listener.h"
#include "server/http/http_server.h"
#include "server/operations/access.h"
#include "server/operations/audit_log.h"
#include "server/operations/log.h"
#include "server/operations/metrics.h"
#include "server/operations/readiness.h"
#include "server/routes/dashboard_routes.h"
#include "server/routes/operator_routes.h"
#include "server/routes/responses.h"
#include "server/routes/routes.h"
#include "server/routes/upload_routes.h"
#include "server/signals.h"
#include "server/worker_processes.h"

namespace slipway::server {
namespace {

// The jobs' store, and the name under which this process and its workers work on them.
struct Jobs {
  std::shared_ptr<api::JobStore> store;
  api::JobRunnerOptions runner;
  std::optional<api::FileLock> lock;
};

// One worker process for each list of kinds.
WorkerProcessOptions worker_processes(const ServeOptions& options, const std::string& data,
                                      const api::JobRunnerOptions& runner) {
  WorkerProcessOptions workers{.commands = {}, .family = runner.worker};
  for (const std::vector<std::string>& kinds : runner.workers) {
    std::vector<std::string> command{"/proc/self/exe", "worker",     "--bell", "--data", data,
                                     "--jobs",         options.jobs, "--name", "{name}"};
    command.insert(command.end(), {"--uploads", options.uploads.folder(options.jobs), "--keep-uploads-mb",
                                   fmt::format("{}", options.uploads.keep_mb)});
    if (!options.artefacts.folder.empty())
      command.insert(command.end(),
                     {"--artefacts", options.artefacts.folder, "--artefact-cache", options.artefacts.cache,
                      "--artefact-cache-mb", fmt::format("{}", options.artefacts.cache_mb)});
    for (const std::string& kind : kinds) command.insert(command.end(), {"--kind", kind});
    command.insert(command.end(), {"--job-memory-mb", fmt::format("{}", options.of_job.memory_mb),
                                   "--job-minutes", fmt::format("{}", options.of_job.minutes), "--lease-s",
                                   fmt::format("{}", options.lease.seconds)});
    workers.commands.push_back(std::move(command));
  }
  return workers;
}

Result<Jobs> open_jobs(const ServeOptions& options) {
  const std::string& path = options.jobs;
  Jobs jobs;
  constexpr double kMsPerDay = 24.0 * 3600.0 * 1000.0, kBytesPerMb = 1e6;
  jobs.runner.kept = api::Retention{.most = static_cast<std::size_t>(options.keep_jobs),
                                    .most_age_ms = static_cast<std::int64_t>(options.keep_days * kMsPerDay),
                                    .most_bytes = static_cast<std::int64_t>(options.keep_mb * kBytesPerMb)};
  jobs.runner.workers = api::worker_kinds();
  jobs.runner.admission = {.most_unfinished = static_cast<std::size_t>(options.most_jobs),
                           .most_of_owner = static_cast<std::size_t>(options.most_jobs_per_address)};
  jobs.runner.max_time = options.of_job.max_time();
  jobs.runner.lease = options.lease.time();
  jobs.runner.works_here = path.empty();  // what is in this process's memory only its threads can work on
  const bool is_file = !path.empty() && !api::is_database(path);
  std::error_code failed;
  if (const auto folder = std::filesystem::path(path).parent_path(); is_file && !folder.empty())
    std::filesystem::create_directories(folder, failed);
  auto store = open_store(path, options.artefacts, api::StoreCheck::kWhole);
  if (!store) return fail(store.error());
  jobs.store = std::move(*store);
  if (path.empty()) return jobs;
  // A process takes back at its start what one of its name left running when it died. One name for all would
  // take the jobs of a service that lives: only the holder of the lock works under the shared name.
  // What workers of a database left running is taken up when its leases end.
  if (is_file) {
    if (auto lock = api::FileLock::take(path + ".lock")) {
      jobs.lock = *std::move(lock);
      return jobs;
    }
  }
  jobs.runner.worker = fmt::format("{} {}", jobs.runner.worker, api::new_job_id());
  return jobs;
}

std::optional<Error> fault_of(const ServeOptions& options) {
  std::vector<Fault> faults;
  for (const std::string& origin : options.allowed_origins)
    if (const auto fault = fault_of_origin(origin))
      faults.push_back({"/allow-origin", fmt::format("\"{}\" is no origin: {}", origin, *fault)});
  if (options.tokens.empty() && !options.no_tokens && !is_loopback(options.address))
    faults.push_back(
        {"/address", fmt::format("{} can be reached from other machines: give --tokens FILE, or --no-tokens "
                                 "where a proxy before it knows who asks",
                                 options.address)});
  if (options.no_workers && options.jobs.empty())
    faults.push_back({"/no-workers", "only this process could work on jobs in its memory: give --jobs"});
  if (faults.empty()) return std::nullopt;
  return Error{ErrorCode::kInvalidRequest, "the service can't be started so", std::move(faults)};
}

// Where what clients send goes; nothing where none is taken.
Result<std::shared_ptr<api::UploadFolder>> open_uploads(const ServeOptions& options, HttpOptions& http) {
  const std::string folder = options.uploads.folder(options.jobs);
  if (folder.empty()) return nullptr;
  const auto unusable = [&](const Error& why) {
    return fail(
        why.code,
        fmt::format("the folder of --uploads, {} ({}), can't be used: {}; --uploads \"\" takes none", folder,
                    options.uploads.given ? "as given" : "beside the jobs' file, as none is given",
                    why.detail));
  };
  auto uploads = api::UploadFolder::open(folder, {.max_total_bytes = options.uploads.max_bytes()});
  if (!uploads) return unusable(uploads.error());
  LargeBodies& large = http.large_bodies;
  large.folder = (*uploads)->files();
  large.paths = {std::string(kUploadsPath)};
  constexpr double kBytesPerMb = 1e6;
  large.max_bytes = static_cast<std::int64_t>(options.upload_mb * kBytesPerMb);
  large.max_total_bytes = 2 * large.max_bytes;
  if (const auto file = BodyFile::make(large.folder, large.under_way); !file)
    return unusable({ErrorCode::kUnwritableFile, file.error().detail, {}});
  return uploads;
}

HttpOptions http_options(const ServeOptions& options) {
  HttpOptions http;
  http.address = options.address;
  http.port = options.port;
  http.problem = problem_response;
  http.log = [](std::string_view line) {
    log_event(LogLevel::kWarning, "http", {{"what", std::string(line)}});
  };
  http.host_names = options.allowed_hosts;
  http.max_connections = static_cast<std::size_t>(options.max_connections);
  http.max_connections_per_address = options.max_connections_per_address > 0
                                         ? static_cast<std::size_t>(options.max_connections_per_address)
                                         : http.max_connections;
  http.cross_origin.origins = options.allowed_origins;
  http.cross_origin.request_headers = {"Authorization", "Content-Type", "Idempotency-Key", "If-None-Match",
                                       "If-Range",      "Prefer",       "Priority",        "Range"};
  http.cross_origin.response_headers = {"Accept-Ranges", "Allow",    "Content-Location",   "Content-Range",
                                        "ETag",          "Location", "Preference-Applied", "Retry-After"};
  return http;
}

// What becomes of jobs whose worker died, and of the words about it.
void on_death(api::JobStore& store, ServiceMetrics& metrics, const std::string& worker,
              const std::string& reason) {
  const auto released = store.release(worker, api::HandBack::kDied, reason);
  metrics.count_worker_death();
  log_event(LogLevel::kWarning, "worker_died",
            {{"worker", worker}, {"reason", reason}, {"jobs", static_cast<double>(released.value_or(0))}});
}

void log_answer(const AnsweredRequest& answered) {
  const HttpRequest& request = answered.request;
  log_event(LogLevel::kInfo, "request",
            {{"id", request.id},
             {"trace", trace_id_of(request.header("traceparent").value_or("")).value_or("")},
             {"address", request.remote_address},
             {"method", request.method},
             {"path", request.path},
             {"status", static_cast<double>(answered.response.status)},
             {"bytes", static_cast<double>(answered.response.body.size())},
             {"seconds", answered.seconds}});
}

// Where a file lies; empty where there is none, or a database in its place.
std::string folder_of(const std::string& file) {
  if (file.empty() || api::is_database(file)) return {};
  const auto folder = std::filesystem::path(file).parent_path();
  return folder.empty() ? std::string(".") : folder.string();
}

// What the service needs to take work. The store and the workers must outlive the checks.
std::vector<ReadinessCheck> readiness_checks(const ServeOptions& options, api::JobStore& store,
                                             const std::optional<WorkerProcesses>& workers) {
  return {[&store]() -> std::optional<std::string> {
            if (const auto there = store.in_place(); !there) return there.error().detail;
            const auto read = store.list(1);
            return read ? std::nullopt
                        : std::optional("the jobs' store does not answer: " + read.error().detail);
          },
          // Before the workers, which can't start on a full disk.
          disk_check({folder_of(options.jobs), options.uploads.folder(options.jobs), options.artefacts.folder,
                      folder_of(options.audit)}),
          [&workers] { return workers ? workers->shortage() : std::nullopt; }};
}

// What SIGHUP asks for: the file of tokens is read anew, and the audit log opened anew, since a rotation has
// moved it. What can't be read or opened leaves what was.
void read_again(Access& access, AuditLog* audit) {
  if (const auto tokens = access.read_again())
    log_event(LogLevel::kInfo, "tokens_read", {{"tokens", static_cast<double>(*tokens)}});
  else
    log_event(LogLevel::kError, "tokens_not_read",
              {{"reason", in_one_line(tokens.error())},
               {"remedy", "the tokens that were known hold: mend the file and send SIGHUP again"}});
  if (audit == nullptr) return;
  if (const auto opened = audit->open_again(); !opened)
    log_event(LogLevel::kError, "audit_log_not_opened", {{"reason", opened.error().detail}});
}

}  // namespace

int serve(const ServeOptions& given) {
  ServeOptions options = given;
  const auto place = api::without_secrets(given.jobs);
  if (!place) return refuse(place.error());
  options.jobs = *place;
  const sigset_t signals = block_signals({SIGINT, SIGTERM, SIGHUP});
  set_log(options.log_json ? LogForm::kJson : LogForm::kText, LogLevel::kInfo);
  if (const auto fault = fault_of(options)) return refuse(*fault);
  const auto data = data_folder(options.data);
  if (!data) return refuse(data.error());
  ServiceMetrics metrics;
  HttpOptions http = http_options(options);
  const auto access = Access::open({.tokens = options.tokens, .max_requests_per_s = options.requests_per_s});
  if (!access) return refuse(access.error());
  std::unique_ptr<AuditLog> audit;
  if (!options.audit.empty()) {
    auto opened = AuditLog::open(options.audit);
    if (!opened) return refuse(opened.error());
    audit = *std::move(opened);
  }
  http.admit = [&access, &audit](HttpRequest& request) -> std::optional<HttpResponse> {
    auto admitted = (*access)->admit(request);
    if (admitted && audit) admitted = audit->can_record(request.method);
    if (admitted) return std::nullopt;
    return problem_response(admitted.error(), &request);
  };
  http.wants_body = [&access](std::string_view method, std::string_view path,
                              const std::optional<std::string>& authorization) {
    return !(*access)->refuses(method, path, authorization);
  };
  http.name_of = [&access](std::string_view method, std::string_view path,
                           const std::optional<std::string>& authorization) {
    return (*access)->name_of(method, path, authorization);
  };
  http.answered = [&, every = options.access_log](const AnsweredRequest& answered) {
    metrics.count_answer(answered);
    if (audit) audit->record(answered);
    if (every) log_answer(answered);
  };
  // First of all: a start that fails for want of the port has touched neither the store nor its jobs.
  auto listener = listen_at(http);
  if (!listener) return refuse(listener.error());
  const auto uploads = open_uploads(options, http);
  if (!uploads) return refuse(uploads.error());
  const auto service = api::Service::open({.data = *data, .uploads = *uploads});
  if (!service) return refuse(service.error());
  std::cerr << left_out_text(*(*service)->catalogue());
  const auto jobs = open_jobs(options);
  if (!jobs) return refuse(jobs.error());
  api::JobRunner runner(jobs->store, api::service_work(**service), jobs->runner,
                        api::service_work_in_parts(**service));
  std::optional<WorkerProcesses> workers;
  if (!jobs->runner.works_here && !options.no_workers) {
    workers.emplace(
        worker_processes(options, *data, jobs->runner),
        [&] {
          runner.ring();
          runner.trim();
        },
        [&](const std::string& name, const std::string& reason) {
          on_death(*jobs->store, metrics, name, reason);
          workers->ring();
        });
    runner.on_change([&] { workers->ring(); });
    runner.on_shortage([&] { return workers->shortage(); });
  }
  if (const auto started = runner.start(); !started) return refuse(started.error());
  if (workers)
    if (const auto started = workers->start(); !started) return refuse(started.error());
  std::optional<HttpServer> server;
  RouteOptions of_routes{.admits = http.wants_body, .override_persons = options.override_persons};
  if (!options.tokens.empty())
    of_routes.knows_token = [&access](const std::string& token) { return (*access)->knows(token); };
  if (const std::string folder = folder_of(options.jobs); !folder.empty()) of_routes.drawing_folder = folder;
  std::vector<Route> routes = api_routes(**service, runner, of_routes);
  const Readiness readiness(readiness_checks(options, *jobs->store, workers));
  const Operation operation{.metrics = metrics,
                            .store = *jobs->store,
                            .http = [&] { return server->counters(); },
                            .not_ready = [&] { return readiness.reason(); }};
  for (Route& route : operator_routes(operation)) routes.push_back(std::move(route));
  for (Route& route : dashboard_routes()) routes.push_back(std::move(route));
  server.emplace(http, std::move(routes));
  const auto port = server->start(*std::move(listener));
  if (!port) return refuse(port.error());
  std::cout << fmt::format("slipway {} serves {} on http://{}:{}, jobs in {}\n", version(), *data,
                           host_in_url(options.address), *port,
                           options.jobs.empty() ? "memory" : options.jobs)
            << std::flush;
  for (int signal = SIGHUP; signal == SIGHUP;)
    if (sigwait(&signals, &signal) == 0 && signal == SIGHUP) read_again(**access, audit.get());
  std::cout << "stopping: running jobs go back to the store\n" << std::flush;
  if (workers) workers->stop();
  runner.stop();
  server->stop();
  return 0;
}

int print_new_token(const std::string& name, const std::string& role) {
  const auto known = role_of(role);
  std::vector<Fault> faults;
  if (!known) faults.push_back({"/role", fmt::format("\"{}\" is no role: viewer, operator or admin", role)});
  if (name.empty() || name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") != std::string::npos)
    faults.push_back({"/name", "must be of lower-case letters, digits, \"_\" and \"-\""});
  if (!faults.empty())
    return refuse({ErrorCode::kInvalidRequest, "the token can't be made so", std::move(faults)});
  const NewToken made = new_token(name, *known);
  std::cerr << "The token, which is not kept anywhere; give it to its holder:\n" << made.token << "\n";
  std::cout << made.entry << std::flush;
  return 0;
}

}  // namespace slipway::server
