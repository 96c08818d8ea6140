#include "server/http/http_host.h"

#include <arpa/inet.h>

#include <algorithm>

#include "server/http/http_message.h"

namespace slipway::server {
namespace {

// "host", "host:80", "[::1]" or "[::1]:80".
std::string name_in(std::string_view header) {
  if (header.starts_with('[')) return std::string(header.substr(1, header.find(']') - 1));
  return std::string(header.substr(0, header.rfind(':')));
}

bool is_address(const std::string& name) {
  in_addr four{};
  in6_addr six{};
  return inet_pton(AF_INET, name.c_str(), &four) == 1 || inet_pton(AF_INET6, name.c_str(), &six) == 1;
}

}  // namespace

std::string host_in_url(const std::string& host) {
  return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

bool names_this_server(std::string_view host_header, const std::vector<std::string>& names) {
  const std::string name = name_in(host_header);
  return is_address(name) || equal_ignoring_case(name, "localhost") ||
         std::any_of(names.begin(), names.end(),
                     [&](const std::string& allowed) { return equal_ignoring_case(name, allowed); });
}

}  // namespace slipway::server
