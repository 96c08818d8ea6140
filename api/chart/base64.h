#pragma once

#include <string>
#include <string_view>

namespace slipway::api {

// Bytes as base64 with padding [RFC 4648], for data: addresses.
std::string base64(std::string_view bytes);

}  // namespace slipway::api
