#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/json/json_value.h"
#include "planner/problem/departure.h"

// What pages and tables say alike of a document's "departures".
namespace slipway::api {

// Of a key such as "departs", ms of UTC since 1970; 0 where there is none.
std::int64_t time_of(const json::JsonValue& object, std::string_view key);

// A window as it is told, see planner::to_the_minute().
planner::DepartureWindow told_window(const json::JsonValue& window);

// "the battery holds 95 % at the arrival (94 % at the worse pace)"; where it would fall below empty "the
// battery is empty at 2193.9 m". `drive`: a best or nearest departure.
std::string battery_words(const json::JsonValue& drive, int decimals);

// Of a drive that keeps an arrive_by that was asked for: when it arrives and how long before. Else nothing.
std::optional<std::string> in_time_words(const json::JsonValue& drive);

// What the paces are of which a day is told.
inline constexpr std::string_view kPaceWords =
    "Of the draws of the ground that come to the end: at the median pace half of them are as fast and need "
    "as "
    "little energy, at the slow pace 95 % of them; the worse pace is, at each place, the one of both that "
    "leaves "
    "less in the battery.";

}  // namespace slipway::api
