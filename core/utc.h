#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace slipway {

// A time since 1970 as RFC 3339 has it, in UTC with milliseconds: "2026-07-01T12:00:00.123Z".
std::string utc_text(std::int64_t ms);

// The time of such a text, with or without a fraction of a second; nothing where it is none, or is of no day
// of the calendar.
std::optional<std::int64_t> utc_of_text(std::string_view text);

// Milliseconds since 1970, by this machine's clock.
std::int64_t now_ms();

}  // namespace slipway
