#include "server/http/http_host.h"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <system_error>

#include "server/http/http_message.h"

namespace slipway::server {
namespace {

bool is_port(std::string_view digits) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  return digits.empty() || (error == std::errc() && end == digits.data() + digits.size());
}

// "host", "host:80", "[::1]" or "[::1]:80" [RFC 9110, 7.2], without the port; empty where it is none of
// these.
std::string_view host_in(std::string_view header) {
  const std::size_t end = header.starts_with('[') ? header.find(']') + 1 : header.find(':');
  const std::string_view host = header.substr(0, end), rest = header.substr(host.size());
  return rest.empty() || (rest.front() == ':' && is_port(rest.substr(1))) ? host : std::string_view();
}

bool is_address(std::string_view host) {
  in_addr four{};
  in6_addr six{};
  if (host.starts_with('[') && host.ends_with(']'))
    return inet_pton(AF_INET6, std::string(host.substr(1, host.size() - 2)).c_str(), &six) == 1;
  return inet_pton(AF_INET, std::string(host).c_str(), &four) == 1;
}

}  // namespace

std::string host_in_url(const std::string& host) {
  return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

bool names_this_server(std::string_view host_header, const std::vector<std::string>& names) {
  const std::string_view name = host_in(host_header);
  return is_address(name) || equal_ignoring_case(name, "localhost") ||
         std::any_of(names.begin(), names.end(),
                     [&](const std::string& allowed) { return equal_ignoring_case(name, allowed); });
}

}  // namespace slipway::server
