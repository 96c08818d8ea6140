#include "server/http/http_server.h"

#include <pthread.h>
#include <sys/resource.h>

#include <csignal>
#include <optional>
#include <thread>
#include <utility>

#include "server/http/http_answers.h"
#include "server/http/http_listener.h"
#include "server/http/http_loop.h"
#include "server/http/http_workers.h"

namespace slipway::server {
namespace {

// Most systems give 1,024 descriptors to who does not ask for more. Where fewer are allowed, connections
// beyond them wait in the backlog.
void ask_for_descriptors(const HttpOptions& options) {
  constexpr rlim_t kForFiles = 256;
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  const rlim_t wanted = std::min<rlim_t>(options.max_connections + kForFiles, limit.rlim_max);
  if (limit.rlim_cur >= wanted) return;
  limit.rlim_cur = wanted;
  static_cast<void>(setrlimit(RLIMIT_NOFILE, &limit));
}

// Threads made while this lives leave signals to the program's own threads.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace

class HttpServer::Running {
 public:
  Running(HttpOptions options, std::vector<Route> routes)
      : options_(std::move(options)), routes_(std::move(routes)), answers_(options_, routes_) {}

  Result<int> start() {
    if (loop_) return fail(ErrorCode::kConflict, "the server is running");
    auto listener = listen_at(options_);
    if (!listener) return fail(std::move(listener.error()));
    return start(*std::move(listener));
  }

  Result<int> start(Listener listener) {
    if (loop_) return fail(ErrorCode::kConflict, "the server is running");
    ask_for_descriptors(options_);
    const int port = listener.port;
    loop_.emplace(options_, answers_, counters_, std::move(listener));
    if (!loop_->fault().empty()) {
      const std::string fault = loop_->fault();
      loop_.reset();
      return fail(ErrorCode::kConflict, fault);
    }
    const SignalsBlocked blocked;
    workers_.emplace(options_, answers_, counters_, [this](WorkDone work) { loop_->done(std::move(work)); });
    thread_ = std::thread([this] { loop_->run(*workers_); });
    return port;
  }

  void stop() {
    if (!thread_.joinable()) return;
    loop_->stop();
    thread_.join();
    workers_->stop();
    // The sockets are the loop's and close with it: not before the last worker has let go of them.
    workers_.reset();
    loop_.reset();
    counters_.open_connections = 0;
    counters_.buffered_bytes = 0;
  }

  HttpCounters counters() const {
    return {counters_.open_connections, counters_.requests_served, counters_.requests_refused,
            counters_.requests_abandoned, counters_.connections_refused};
  }

 private:
  HttpOptions options_;
  RouteTable routes_;
  Answers answers_;
  LiveCounters counters_;
  std::optional<HttpLoop> loop_;
  std::optional<HttpWorkers> workers_;
  std::thread thread_;
};

HttpServer::HttpServer(HttpOptions options, std::vector<Route> routes)
    : running_(std::make_unique<Running>(std::move(options), std::move(routes))) {}

HttpServer::~HttpServer() {
  running_->stop();
}

Result<int> HttpServer::start() {
  return running_->start();
}

Result<int> HttpServer::start(Listener listener) {
  return running_->start(std::move(listener));
}

void HttpServer::stop() {
  running_->stop();
}

HttpCounters HttpServer::counters() const {
  return running_->counters();
}

}  // namespace slipway::server
