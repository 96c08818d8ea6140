#include "api/maps/contours.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "api/export/answer_vectors.h"
#include "dem/write/contours.h"

namespace slipway::api {

Result<std::string> contours(const TerrainSite& site, const ContourRequest& request, Progress& progress) {
  progress.report("reading the terrain", 0.0);
  const dem::ElevationInfo& info = site.info();
  const auto ground = site.read_elevation(request.extent.value_or(info.geometry.extent()));
  if (!ground) return fail(ground.error());
  auto layer = dem::contours_of(**ground, request.every_m, request.base_m, progress);
  if (!layer) return fail(layer.error());
  std::vector<dem::VectorLayer> layers;
  layers.push_back(*std::move(layer));
  if (request.geopackage) return dem::encode_geopackage(layers, info.crs_wkt);
  const json::AnswerMap map{info.crs_name, info.crs_wkt, info.body, info.semi_major_axis_m,
                            info.geometry.extent()};
  return json::layers_geojson(
      std::move(layers), map,
      request.lonlat ? json::VectorCoordinates::kLongitudeLatitude : json::VectorCoordinates::kMap);
}

}  // namespace slipway::api
