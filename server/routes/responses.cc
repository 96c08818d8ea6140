#include "server/routes/responses.h"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <utility>

#include "api/json/problem_document.h"
#include "core/digest.h"
#include "server/routes/query.h"
#include "server/routes/request_headers.h"

namespace slipway::server {

HttpResponse document(std::string body, int status) {
  HttpResponse response;
  response.status = status;
  response.content_type = "application/json";
  response.body = std::move(body);
  response.headers.emplace_back("Cache-Control", "no-cache");
  return response;
}

HttpResponse problem_response(const Error& error, const HttpRequest* /*request*/) {
  const ErrorRow& row = error_row(error.code);
  HttpResponse response;
  response.status = row.http_status;
  response.content_type = "application/problem+json";
  response.body = api::json::write_problem(error);
  response.headers.emplace_back("Cache-Control", "no-store");
  constexpr int kTooMany = 429, kUnavailable = 503;
  constexpr int kRetrySeconds = 5;
  if (row.http_status == kUnavailable || row.http_status == kTooMany)
    response.headers.emplace_back("Retry-After", std::to_string(kRetrySeconds));
  if (error.code == ErrorCode::kUnauthorized)
    response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"slipway\"");
  return response;
}

HttpResponse problem(ErrorCode code, std::string detail, const HttpRequest& request) {
  return problem_response(Error{code, std::move(detail), {}}, &request);
}

std::string tag_of(std::string_view bytes) {
  return fmt::format("\"{:016x}\"", fnv1a(bytes));
}

HttpResponse tagged(HttpResponse response, const std::string& tag, const HttpRequest& request) {
  response.headers.emplace_back("ETag", tag);
  if (is_known_to_client(request, tag)) {
    response.status = 304;
    response.body.clear();
    response.pieces = nullptr;
    response.pieces_bytes.reset();
    response.content_type.clear();
  }
  return response;
}

Route fixed(std::string pattern, std::string body) {
  auto shared = std::make_shared<const std::string>(std::move(body));
  const std::string tag = tag_of(*shared);
  return {"GET", std::move(pattern), [shared, tag](const HttpRequest& request) {
            if (const auto error = Query(request, {}).error()) return problem_response(*error, &request);
            return tagged(document(*shared), tag, request);
          }};
}

}  // namespace slipway::server
