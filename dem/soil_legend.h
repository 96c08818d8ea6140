#pragma once

#include <string>
#include <vector>

#include "dem/soil_map.h"

namespace slipway::dem {

// Values or labels that occur twice in a legend, as faults at "/legend/3/value" or "/legend/3/label". A
// raster is matched by values, polygons by labels.
std::vector<Fault> repeated_values(const std::vector<SoilClass>& legend);
std::vector<Fault> repeated_labels(const std::vector<SoilClass>& legend);

}  // namespace slipway::dem
