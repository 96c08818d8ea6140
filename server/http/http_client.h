#pragma once

#include <chrono>
#include <string>

#include "core/result.h"
#include "server/http/http_message.h"

namespace slipway::server {

struct HttpCall {
  std::string method = "GET";
  std::string host = "127.0.0.1";  // a name or an address, that of IPv6 without brackets
  int port = 80;
  std::string path = "/";  // with its query, percent-encoded
  NamedValues headers;
  std::string body;
  std::string content_type = "application/json";          // sent when there is a body
  std::chrono::milliseconds timeout{10'000};              // for connecting, and for each pause in the answer
  std::size_t max_answer_bytes = std::size_t{256} << 20;  // a client's memory is not the server's to fill
};

// One request on a connection of its own. Every answer of the server is a value here, also one with an
// error's status; an error means that there was no answer.
Result<HttpResponse> http_request(const HttpCall& call);

}  // namespace slipway::server
