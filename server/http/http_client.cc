#include "server/http/http_client.h"

#include <fmt/format.h>
#include <httplib.h>

#include <utility>

#include "server/http/http_host.h"

namespace slipway::server {
namespace {

Error no_answer(const HttpCall& call, httplib::Error error) {
  const std::string place = fmt::format("{} port {}", call.host, call.port);
  switch (error) {
    case httplib::Error::Connection:
    case httplib::Error::BindIPAddress:
      return {ErrorCode::kNotFound, fmt::format("no server answers at {}", place), {}};
    case httplib::Error::ConnectionTimeout:
    case httplib::Error::Read:
      return {ErrorCode::kRequestTimeout,
              fmt::format("{} did not answer within {} ms, or closed the connection", place,
                          call.timeout.count()),
              {}};
    default:
      return {ErrorCode::kInternal,
              fmt::format("the exchange with {} failed: {}", place, httplib::to_string(error)),
              {}};
  }
}

}  // namespace

Result<HttpResponse> http_request(const HttpCall& call) {
  httplib::Client client(call.host, call.port);
  client.set_connection_timeout(call.timeout);
  client.set_read_timeout(call.timeout);
  client.set_write_timeout(call.timeout);
  client.set_tcp_nodelay(true);
  client.set_keep_alive(false);

  httplib::Request request;
  request.method = call.method;
  request.path = call.path;
  request.set_header("Host", fmt::format("{}:{}", host_in_url(call.host), call.port));
  for (const auto& [name, value] : call.headers) request.set_header(name, value);
  if (!call.body.empty()) {
    request.body = call.body;
    if (!request.has_header("Content-Type")) request.set_header("Content-Type", call.content_type);
  }
  std::string body;
  bool too_large = false;
  request.content_receiver = [&](const char* data, std::size_t size, std::uint64_t, std::uint64_t) {
    too_large = body.size() + size > call.max_answer_bytes;
    if (!too_large) body.append(data, size);
    return !too_large;
  };

  const httplib::Result result = client.send(request);
  if (too_large) {
    return fail(ErrorCode::kPayloadTooLarge,
                fmt::format("the answer has more than the {} bytes that are read", call.max_answer_bytes));
  }
  if (!result) return fail(no_answer(call, result.error()));
  HttpResponse out;
  out.status = result->status;
  out.body = std::move(body);
  for (const auto& [name, value] : result->headers) {
    if (equal_ignoring_case(name, "Content-Type")) out.content_type = value;
    out.headers.emplace_back(name, value);
  }
  return out;
}

}  // namespace slipway::server
