#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slipway::server {

// Whether the value of a Host header names this server: an address as numbers, localhost or a name of the
// list, without regard to case and port. A page of another site whose name was turned to this machine's
// address (DNS rebinding) reaches it under that name.
bool names_this_server(std::string_view host_header, const std::vector<std::string>& names);

}  // namespace slipway::server
