#pragma once

#include <optional>
#include <string>

#include "api/files/terrain_site.h"
#include "core/progress.h"
#include "core/result.h"
#include "dem/grid_geometry.h"

namespace slipway::api {

struct ContourRequest {
  std::optional<dem::Extent> extent;  // where it is empty, the whole terrain
  double every_m = 5.0, base_m = 0.0;
  bool geopackage = true;  // otherwise GeoJSON
  bool lonlat = false;     // of GeoJSON: degrees of the body
};

// The file's bytes. Errors: those of dem::ElevationSource::read and dem::contours_of.
Result<std::string> contours(const TerrainSite& site, const ContourRequest& request, Progress& progress);

}  // namespace slipway::api
