#pragma once

#include <memory>
#include <vector>

#include "core/result.h"
#include "server/http/http_listener.h"
#include "server/http/http_message.h"
#include "server/http/http_options.h"
#include "server/http/http_routes.h"

namespace slipway::server {

// An HTTP/1.1 server for programs that must stay up: clients that are slow, greedy or malicious cost a
// bounded amount of memory and none of the others' time. Every refusal is a problem document.
class HttpServer {
 public:
  // Throws std::invalid_argument when a route's pattern is malformed or two routes can't be told apart.
  HttpServer(HttpOptions options, std::vector<Route> routes);
  ~HttpServer();  // stops
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  // Binds and serves from threads of its own; the port it got, or why it can't listen there. For one thread,
  // as stop() is, after which it may be started again.
  Result<int> start();
  // The same on a port that listen_at() has bound before: a program binds first, so that a start that fails
  // for want of the port has changed nothing.
  Result<int> start(Listener listener);

  // New connections and requests are refused, those that have begun are answered up to
  // options.drain_deadline. A handler that is still running then is waited for: threads can't be ended from
  // outside.
  void stop();

  // From any thread.
  HttpCounters counters() const;

 private:
  class Running;
  std::unique_ptr<Running> running_;
};

}  // namespace slipway::server
