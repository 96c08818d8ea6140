#pragma once

#include <string_view>

#include "api/json/writer.h"
#include "gap/estimate/interval.h"

namespace slipway::api::json {

// value and interval_90 of the object that is being written, each times the unit. What no number was found
// for is not there, nor an interval that does not hold its value.
void write_interval_keys(Writer& w, const gap::Interval& interval, double unit = 1.0);
// An object of the two.
void write_interval(Writer& w, std::string_view key, const gap::Interval& interval, double unit = 1.0);
// A number that may not have been found: then the key is not there.
void write_finite(Writer& w, std::string_view key, double value);

}  // namespace slipway::api::json
