#pragma once

#include <string_view>

#include "api/files/catalogue.h"
#include "api/requests/wheel_sweep_request.h"
#include "core/result.h"

namespace slipway::api {

// Reads a request and finds its names in the catalogue; all faults together, with JSON pointers.
Result<WheelSweepAnswer> read_wheel_sweep(const Catalogue& catalogue, std::string_view json);

// The same with its rows.
Result<WheelSweepAnswer> run_wheel_sweep(const Catalogue& catalogue, std::string_view json);

}  // namespace slipway::api
