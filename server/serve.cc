#include <fmt/format.h>

#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <system_error>

#include "api/job_kinds.h"
#include "api/jobs/job_runner.h"
#include "api/jobs/memory_job_store.h"
#include "api/jobs/sqlite_job_store.h"
#include "api/service.h"
#include "core/version.h"
#include "server/cli/commands.h"
#include "server/cli/data_folder.h"
#include "server/cli/tables.h"
#include "server/http/http_server.h"
#include "server/routes.h"

namespace slipway::server {
namespace {

Result<std::shared_ptr<api::JobStore>> open_store(const std::string& path) {
  if (path.empty()) return std::shared_ptr<api::JobStore>(api::make_memory_job_store());
  std::error_code failed;
  if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty())
    std::filesystem::create_directories(folder, failed);
  auto store = api::open_sqlite_job_store(path);
  if (!store) return fail(store.error());
  return std::shared_ptr<api::JobStore>(std::move(*store));
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

int refuse(const Error& error) {
  std::cerr << error_text(error);
  return 1;
}

}  // namespace

int serve(const ServeOptions& options) {
  const sigset_t signals = block_ending_signals();
  const auto data = data_folder(options.data);
  if (!data) return refuse(data.error());
  const auto service = api::Service::open({.data = *data});
  if (!service) return refuse(service.error());
  const auto store = open_store(options.jobs);
  if (!store) return refuse(store.error());
  api::JobRunner runner(*store, api::service_work(**service));
  if (const auto started = runner.start(); !started) return refuse(started.error());

  HttpOptions http;
  http.address = options.address;
  http.port = options.port;
  http.problem = problem_response;
  HttpServer server(http, api_routes(**service, runner));
  const auto port = server.start();
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
