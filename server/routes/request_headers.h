#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "api/jobs/job_runner.h"
#include "core/result.h"
#include "server/http/http_message.h"

// What the headers of a request ask for.
namespace slipway::server {

// Whether the client names this media type in Accept.
bool accepts(const HttpRequest& request, std::string_view type);

// Whether the client takes answers in this coding (gzip).
bool accepts_encoding(const HttpRequest& request, std::string_view coding);

// Whether the client has the version with this tag already [RFC 9110, 13.1.2].
bool is_known_to_client(const HttpRequest& request, std::string_view tag);

// The header Prefer [RFC 7240]; what is malformed or not known is ignored, as the RFC says.
struct Preferences {
  std::optional<std::chrono::seconds> wait;
  bool respond_async = false;
};
Preferences preferences_of(const HttpRequest& request);

// How a job is asked for: Idempotency-Key [draft-ietf-httpapi-idempotency-key-header] and the urgency of
// Priority [RFC 9218]; an urgency that is malformed is the usual one, as the RFC says. The owner is who
// asks. Errors: invalid_request at /Idempotency-Key where that is longer
// than 255 bytes or not of visible characters.
Result<api::Submission> submission_of(const HttpRequest& request);

}  // namespace slipway::server
