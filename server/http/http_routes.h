#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "server/http/http_message.h"

namespace slipway::server {

// Which threads answer a route, each sort for its own routes alone, so that none waits behind another.
enum class Threads {
  kLight,    // who polls
  kHeavy,    // what takes long or much memory, a few at once
  kPicture,  // pictures and tiles of the ground, a few at once
  kShadow,   // pictures of shadows, which take longer: one at a time
  kDrawn,    // whole answers that are drawn into a file first, which may take minutes: one at a time
  kAsking,   // requests that are checked, and clients that wait for their end
  kPrompt,   // what waits for nothing, no store and no other thread
};

// What answers one method at the addresses of one pattern. "/v1/jobs/{id}" has three segments, and the last
// one stands for any non-empty text without a slash, found again under request.parameter("id").
struct Route {
  std::string method;
  std::string pattern;
  std::function<HttpResponse(const HttpRequest&)> handle;  // called from several threads at once
  Threads threads = Threads::kLight;
};

// The routes, matched segment by segment: cpp-httplib's patterns are std::regex, which some patterns bring to
// a standstill. A literal segment wins over one in braces, the leftmost difference decides.
class RouteTable {
 public:
  // Throws std::invalid_argument when a pattern is malformed or two routes could never be told apart.
  explicit RouteTable(std::vector<Route> routes);

  // The route's answer. HEAD is answered by a GET route, OPTIONS with the methods allowed. An address that is
  // not known, or not with this method, goes through `problem`.
  HttpResponse answer(HttpRequest& request,
                      const std::function<HttpResponse(const Error&, const HttpRequest*)>& problem) const;
  // The route that answers this method at this address, as it was sent, without its query; nullptr: none.
  const Route* find(std::string_view method, std::string_view raw_path) const;

 private:
  struct Entry {
    Route route;
    std::vector<std::string> segments;
  };

  std::string allowed(const std::vector<const Entry*>& entries) const;

  std::vector<Entry> entries_;  // the more literal pattern first
};

}  // namespace slipway::server
