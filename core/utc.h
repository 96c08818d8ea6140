#pragma once

#include <cstdint>
#include <string>

namespace slipway {

// A time since 1970 as RFC 3339 has it, in UTC with milliseconds: "2026-07-01T12:00:00.123Z".
std::string utc_text(std::int64_t ms);

// Milliseconds since 1970, by this machine's clock.
std::int64_t now_ms();

}  // namespace slipway
