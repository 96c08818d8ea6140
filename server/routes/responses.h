#pragma once

#include <string>
#include <string_view>

#include "core/result.h"
#include "server/http/http_message.h"
#include "server/http/http_routes.h"

// The forms that the routes' answers have.
namespace slipway::server {

// A JSON document that a client may keep but must revalidate.
HttpResponse document(std::string body, int status = 200);

// An error as application/problem+json, with the headers that go with it. The request may be null.
HttpResponse problem_response(const Error& error, const HttpRequest* request);
HttpResponse problem(ErrorCode code, std::string detail, const HttpRequest& request);

// An entity tag of these bytes, the same on every machine.
std::string tag_of(std::string_view bytes);
// Adds the tag, and answers 304 to a client that has this version already.
HttpResponse tagged(HttpResponse response, const std::string& tag, const HttpRequest& request);

// GET of a document that never changes while the program runs.
Route fixed(std::string pattern, std::string body);

}  // namespace slipway::server
