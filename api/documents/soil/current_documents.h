#pragma once

#include <string>

#include "api/requests/current_inversion.h"
#include "api/requests/current_maps.h"

namespace slipway::api::json {

// "current_map/1": the panels with their axes and points. A point where the wheel is sunk has a reason for a
// current.
std::string write_current_maps(const CurrentMaps& maps);

// "current_inverse/1".
std::string write_current_inversion(const CurrentInversion& inversion);

}  // namespace slipway::api::json
