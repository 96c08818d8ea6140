#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "server/http/http_message.h"

// What the headers of a request ask for.
namespace slipway::server {

// Whether the client names this media type in Accept.
bool accepts(const HttpRequest& request, std::string_view type);

// Whether the client has the version with this tag already [RFC 9110, 13.1.2].
bool is_known_to_client(const HttpRequest& request, std::string_view tag);

// The header Prefer [RFC 7240]; what is malformed or not known is ignored, as the RFC says.
struct Preferences {
  std::optional<std::chrono::seconds> wait;
  bool respond_async = false;
};
Preferences preferences_of(const HttpRequest& request);

}  // namespace slipway::server
