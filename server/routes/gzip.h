#pragma once

#include <string>
#include <string_view>

namespace slipway::server {

// The bytes as a gzip file [RFC 1952].
std::string gzipped(std::string_view bytes);

}  // namespace slipway::server
