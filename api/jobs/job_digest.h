#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace slipway::api {

// SHA-256 digests that stand beside stored bytes. They take in what the bytes belong to, so that rows that
// were swapped are noticed like bytes that were altered.
std::string request_digest(std::string_view id, std::string_view kind, std::string_view request);
std::string outcome_digest(std::string_view id, std::string_view state, std::string_view outcome);
std::string series_digest(std::string_view id, std::int64_t page, std::string_view bytes);

}  // namespace slipway::api
