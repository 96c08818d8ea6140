#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace slipway {

// A time since 1970 as RFC 3339 has it, in UTC with milliseconds: "2026-07-01T12:00:00.123Z".
std::string utc_text(std::int64_t ms);

// The same for people, to the second: "2026-07-01 12:00:17 UTC", of a whole minute "2026-07-01 12:00 UTC".
// What need not be so exact is rounded to the minute before.
std::string utc_words(std::int64_t ms);

// The first whole minute that is not before a time: an arrival must not be said to be earlier than it is.
std::int64_t minute_after(std::int64_t ms);

// How long something lasts, without its sign and never more than it is: "17 s", "44 min", "3.9 h".
std::string span_words(double seconds);

// The time of a text as utc_text() has it, with or without a fraction of a second; nothing where it is none,
// or is of no day of the calendar.
std::optional<std::int64_t> utc_of_text(std::string_view text);

// Milliseconds since 1970, by this machine's clock.
std::int64_t now_ms();

}  // namespace slipway
