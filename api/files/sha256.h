#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace slipway::api {

// SHA-256 [FIPS 180-4] of the parts, each with its length before it, as 64 hexadecimal digits: two lists of
// parts have the same digest only where they are the same.
std::string sha256_of(std::initializer_list<std::string_view> parts);

}  // namespace slipway::api
