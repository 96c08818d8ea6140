#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/http/http_engine.h"
#include "server/http/http_head.h"
#include "server/http/http_message.h"
#include "server/http/http_options.h"
#include "server/http/http_routes.h"

namespace slipway::server {

// What becomes of a request, and of an exception: the one place where those are caught.
class Answers {
 public:
  // Both outlive this.
  Answers(const HttpOptions& options, const RouteTable& routes) : options_(options), routes_(routes) {}

  // Never throws.
  HttpEngine::Outgoing to_request(HttpEngine& engine, HttpEngine::Exchange exchange) const;
  // In the place of the answer to the request with this head.
  HttpEngine::Outgoing instead(HttpEngine& engine, std::string_view head, const Error& error) const;
  const Route* route_of(const RequestHead& head) const;
  // What is known of a request that is refused before it is whole.
  struct Refused {
    std::string_view method;
    std::optional<std::string> origin;  // of the web page that asks
  };
  // In one piece: it is sent from a buffer of the loop.
  std::string to_refused(HttpEngine& engine, const Refused& refused, const Error& error) const;

  void log(std::string_view line) const;

 private:
  HttpResponse problem(const Error& error, const HttpRequest* request) const;
  // The answer to a request, with what lets pages of other origins read it.
  HttpResponse routed(HttpRequest& request) const;
  HttpResponse answered(HttpRequest& request) const;

  const HttpOptions& options_;
  const RouteTable& routes_;
};

}  // namespace slipway::server
