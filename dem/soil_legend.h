#pragma once

#include <string>
#include <vector>

#include "dem/soil_map.h"

namespace slipway::dem {

// What makes a legend ambiguous, as faults at "/legend/3/value" or "/legend/3/label". Values matter where a
// raster is matched, labels where polygons are.
std::vector<Fault> repeated_values(const std::vector<SoilClass>& legend);
std::vector<Fault> repeated_labels(const std::vector<SoilClass>& legend);

}  // namespace slipway::dem
