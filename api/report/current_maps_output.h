#pragma once

#include <string>

#include "api/requests/current_maps.h"

namespace slipway::api {

// A line a point, with the soil's parameters in force there.
std::string current_maps_csv(const CurrentMaps& maps);
std::string draw_current_maps(const CurrentMaps& maps);

}  // namespace slipway::api
