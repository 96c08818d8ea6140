#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slipway::server {

// A host as it stands in addresses and in Host: an IPv6 address in brackets [RFC 3986, 3.2.2].
std::string host_in_url(const std::string& host);

// Whether the value of a Host header names this server: an address as numbers, localhost or a name of the
// list, without regard to case and port. A page of another site whose name was turned to this machine's
// address (DNS rebinding) reaches it under that name.
bool names_this_server(std::string_view host_header, const std::vector<std::string>& names);

}  // namespace slipway::server
