#include "server/http/http_cross_origin.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace slipway::server {
namespace {

// Adds a name to the list in the answer's Vary header.
void vary_with(HttpResponse& response, std::string_view name) {
  for (auto& [header, value] : response.headers) {
    if (!equal_ignoring_case(header, "Vary")) continue;
    value += fmt::format(", {}", name);
    return;
  }
  response.headers.emplace_back("Vary", name);
}

bool is_host(std::string_view host) {
  // An address of IPv6 stands in brackets.
  if (host.starts_with('[') && host.ends_with(']') && host.size() > 2)
    return host.substr(1, host.size() - 2).find_first_not_of("0123456789abcdef:.") == std::string_view::npos;
  return !host.empty() &&
         host.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyz.-_") == std::string_view::npos;
}

// What is wrong with the digits of a port after the colon.
std::optional<std::string> fault_of_port(std::string_view digits, int usual) {
  int port = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (error != std::errc() || end != digits.data() + digits.size() || port < 1 || port > 65535)
    return "its port must be in [1, 65535]";
  if (port == usual || digits.front() == '0')
    return "browsers leave out a scheme's own port and leading zeros";
  return std::nullopt;
}

}  // namespace

std::optional<std::string> fault_of_origin(std::string_view text) {
  constexpr std::string_view kPlain = "http://";
  constexpr std::string_view kSecure = "https://";
  const bool secure = text.starts_with(kSecure);
  if (!secure && !text.starts_with(kPlain)) return "it must be http://HOST[:PORT] or https://HOST[:PORT]";
  text.remove_prefix(secure ? kSecure.size() : kPlain.size());
  const std::size_t bracket = text.rfind(']');
  const std::size_t colon = text.find(':', bracket == std::string_view::npos ? 0 : bracket);
  if (!is_host(text.substr(0, colon)))
    return "its host must be in lower case, without a path, a user or a final slash";
  if (colon == std::string_view::npos) return std::nullopt;
  constexpr int kPlainPort = 80;
  constexpr int kSecurePort = 443;
  return fault_of_port(text.substr(colon + 1), secure ? kSecurePort : kPlainPort);
}

void share_across_origins(const CrossOrigin& allowed, const HttpRequest& request, HttpResponse& response) {
  if (allowed.origins.empty()) return;
  // Whoever asks, so that no cache gives one origin the answer of another.
  vary_with(response, "Origin");
  const auto origin = request.header("Origin");
  if (!origin || std::find(allowed.origins.begin(), allowed.origins.end(), *origin) == allowed.origins.end())
    return;
  response.headers.emplace_back("Access-Control-Allow-Origin", *origin);
  if (request.method != "OPTIONS" || !request.header("Access-Control-Request-Method")) {
    response.headers.emplace_back("Access-Control-Expose-Headers",
                                  fmt::format("{}", fmt::join(allowed.response_headers, ", ")));
    return;
  }
  vary_with(response, "Access-Control-Request-Method");
  vary_with(response, "Access-Control-Request-Headers");
  response.headers.emplace_back("Access-Control-Allow-Methods", response.header("Allow").value_or(""));
  response.headers.emplace_back("Access-Control-Allow-Headers",
                                fmt::format("{}", fmt::join(allowed.request_headers, ", ")));
  response.headers.emplace_back("Access-Control-Max-Age", std::to_string(allowed.preflight_kept.count()));
}

}  // namespace slipway::server
