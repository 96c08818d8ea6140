#pragma once

#include <string>
#include <string_view>

#include "api/requests/wheel_sweep_request.h"
#include "core/result.h"

namespace slipway::api::json {

// "wheel_sweep/1": the request with its defaults, the columns with their units, and a row a test. What a row
// has no value for (a current without a motor, anything but the reason where the wheel is sunk) is not in it.
std::string write_wheel_sweep_answer(const WheelSweepAnswer& answer);

// The same rows as CSV (RFC 4180 but for the line's end, which is LF): a header of the columns' names, what
// is not there left empty. Takes the document; errors: internal, where it is not of that kind.
Result<std::string> wheel_sweep_csv(std::string_view document);

// One field of a line, in quotes where it must be.
std::string csv_field(const std::string& text);

}  // namespace slipway::api::json
