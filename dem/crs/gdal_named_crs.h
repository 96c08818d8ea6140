#pragma once

#include <ogr_spatialref.h>

#include <memory>
#include <string>

namespace slipway::dem {

// The system that a text from outside names, see fault_of_crs_text(); null where it may not, or where it is
// not known. This is the only place where such a text is handed to GDAL.
std::unique_ptr<OGRSpatialReference> named_crs(const std::string& text);

}  // namespace slipway::dem
