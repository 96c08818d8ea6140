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
#include "api/jobs/memory_job_store.h"
#include "api/jobs/sqlite_job_store.h"
#include "api/service.h"
#include "core/version.h"
#include "server/cli/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/serve_command.h"
#include "server/cli/terminal/tables.h"
#include "server/http/http_cross_origin.h"
#include "server/http/http_listener.h"
#include "server/http/http_server.h"
#include "server/responses.h"
#include "server/routes.h"

namespace slipway::server {
namespace {

// The jobs' store, and the name under which this process works on them.
struct Jobs {
  std::shared_ptr<api::JobStore> store;
  api::JobRunnerOptions runner;
  std::optional<api::FileLock> lock;
};

Result<Jobs> open_jobs(const ServeOptions& options) {
  const std::string& path = options.jobs;
  Jobs jobs;
  constexpr double kMsPerDay = 24.0 * 3600.0 * 1000.0, kBytesPerMb = 1e6;
  jobs.runner.kept = {.most = static_cast<std::size_t>(options.keep_jobs),
                      .most_age_ms = static_cast<std::int64_t>(options.keep_days * kMsPerDay),
                      .most_bytes = static_cast<std::int64_t>(options.keep_mb * kBytesPerMb)};
  jobs.runner.workers = api::worker_kinds();
  if (path.empty()) {
    jobs.store = api::make_memory_job_store();
    return jobs;
  }
  std::error_code failed;
  if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty())
    std::filesystem::create_directories(folder, failed);
  auto store = api::open_sqlite_job_store(path);
  if (!store) return fail(store.error());
  jobs.store = std::move(*store);
  // A process takes back at its start what one of its name left running when it died. One name for all would
  // take the jobs of a service that lives: only the holder of the lock works under the shared name.
  auto lock = api::FileLock::take(path + ".lock");
  if (lock) {
    jobs.lock = *std::move(lock);
  } else {
    jobs.runner.worker = fmt::format("{} {}", jobs.runner.worker, api::new_job_id());
  }
  return jobs;
}

// Blocks the signals that end the program, so that every thread started later leaves them to
// sigwait().
sigset_t block_ending_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  return signals;
}

std::optional<Error> fault_of(const ServeOptions& options) {
  std::vector<Fault> faults;
  for (const std::string& origin : options.allowed_origins)
    if (const auto fault = fault_of_origin(origin))
      faults.push_back({"/allow-origin", fmt::format("\"{}\" is no origin: {}", origin, *fault)});
  if (faults.empty()) return std::nullopt;
  return Error{ErrorCode::kInvalidRequest, "the service can't be started so", std::move(faults)};
}

HttpOptions http_options(const ServeOptions& options) {
  HttpOptions http;
  http.address = options.address;
  http.port = options.port;
  http.problem = problem_response;
  http.host_names = options.allowed_hosts;
  http.max_connections = static_cast<std::size_t>(options.max_connections);
  http.max_connections_per_address = options.max_connections_per_address > 0
                                         ? static_cast<std::size_t>(options.max_connections_per_address)
                                         : http.max_connections;
  http.cross_origin.origins = options.allowed_origins;
  http.cross_origin.request_headers = {"Content-Type", "If-None-Match", "Prefer"};
  http.cross_origin.response_headers = {"Allow",    "Content-Location",   "ETag",
                                        "Location", "Preference-Applied", "Retry-After"};
  return http;
}

}  // namespace

int serve(const ServeOptions& options) {
  const sigset_t signals = block_ending_signals();
  if (const auto fault = fault_of(options)) return refuse(*fault);
  const auto data = data_folder(options.data);
  if (!data) return refuse(data.error());
  const HttpOptions http = http_options(options);
  // First of all: a start that fails for want of the port has touched neither the store nor its jobs.
  auto listener = listen_at(http);
  if (!listener) return refuse(listener.error());
  const auto service = api::Service::open({.data = *data});
  if (!service) return refuse(service.error());
  std::cerr << left_out_text((*service)->catalogue());
  const auto jobs = open_jobs(options);
  if (!jobs) return refuse(jobs.error());
  api::JobRunner runner(jobs->store, api::service_work(**service), jobs->runner);
  if (const auto started = runner.start(); !started) return refuse(started.error());
  HttpServer server(http, api_routes(**service, runner));
  const auto port = server.start(*std::move(listener));
  if (!port) return refuse(port.error());
  std::cout << fmt::format("slipway {} serves {} on http://{}:{}, jobs in {}\n", version(), *data,
                           options.address, *port, options.jobs.empty() ? "memory" : options.jobs)
            << std::flush;
  int signal = 0;
  sigwait(&signals, &signal);
  std::cout << "stopping: running jobs go back to the store\n" << std::flush;
  runner.stop();
  server.stop();
  return 0;
}

}  // namespace slipway::server
