#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/http/http_message.h"
#include "server/http/http_options.h"

namespace slipway::server {

// Why the text is no origin that could be allowed; nothing where it is one: "http" or "https", "://", a host
// in lower case and a port that is not the scheme's own. Browsers send an origin in this form and no other
// [RFC 6454, 6.2], so that a comparison of texts decides.
std::optional<std::string> fault_of_origin(std::string_view text);

// Adds to an answer what lets the pages of the allowed origins read it, and to the answer of OPTIONS what
// they may send. Without allowed origins nothing is added.
void share_across_origins(const CrossOrigin& allowed, const HttpRequest& request, HttpResponse& response);

}  // namespace slipway::server
