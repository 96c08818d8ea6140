#include <ogr_spatialref.h>

#include <cmath>

#include "core/angle.h"
#include "dem/body_degrees.h"
#include "dem/gdal_session.h"

namespace slipway::dem {

struct BodyDegrees::Transformations {
  std::unique_ptr<OGRCoordinateTransformation> to_map, to_degrees;
  double graphic_per_centric = 1.0;  // of the tangents of the latitudes: 1 / (1 - e^2)
};

BodyDegrees::BodyDegrees(const std::string& crs_wkt, const std::string& body) {
  const GdalSession session;  // prepares the process, and keeps complaints to itself
  OGRSpatialReference map;
  if (crs_wkt.empty() || map.importFromWkt(crs_wkt.c_str()) != OGRERR_NONE || map.IsProjected() == 0) return;
  map.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRSpatialReference degrees;
  degrees.SetGeogCS("longitude and latitude", "the elevation's datum", "its ellipsoid", map.GetSemiMajor(),
                    map.GetInvFlattening(), nullptr, map.GetPrimeMeridian());
  degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRCoordinateTransformationOptions options;
  options.SetBallparkAllowed(true);
  auto made = std::make_unique<Transformations>();
  made->to_map.reset(OGRCreateCoordinateTransformation(&degrees, &map, options));
  made->to_degrees.reset(OGRCreateCoordinateTransformation(&map, &degrees, options));
  const double axis_ratio = map.GetSemiMinor() / map.GetSemiMajor();
  if (body != "Earth") made->graphic_per_centric = 1.0 / (axis_ratio * axis_ratio);
  if (made->to_map && made->to_degrees) transformations_ = std::move(made);
}

BodyDegrees::~BodyDegrees() = default;
BodyDegrees::BodyDegrees(BodyDegrees&&) noexcept = default;
BodyDegrees& BodyDegrees::operator=(BodyDegrees&&) noexcept = default;

bool BodyDegrees::usable() const {
  return transformations_ != nullptr;
}

std::optional<MapPlace> BodyDegrees::to_map(const MapPlace& degrees) const {
  if (!usable()) return std::nullopt;
  // PROJ wants the latitude planetographic: tan(graphic) = tan(centric) / (1 - e^2).
  const double centric = rad_from_deg(degrees.y);
  double x = degrees.x;
  double y =
      deg_from_rad(std::atan2(transformations_->graphic_per_centric * std::sin(centric), std::cos(centric)));
  if (transformations_->to_map->Transform(1, &x, &y) == FALSE || !std::isfinite(x) || !std::isfinite(y))
    return std::nullopt;
  return MapPlace{x, y};
}

std::optional<MapPlace> BodyDegrees::to_degrees(const MapPlace& map) const {
  if (!usable()) return std::nullopt;
  double x = map.x, y = map.y;
  if (transformations_->to_degrees->Transform(1, &x, &y) == FALSE || !std::isfinite(x) || !std::isfinite(y))
    return std::nullopt;
  const double graphic = rad_from_deg(y);
  return MapPlace{x, deg_from_rad(std::atan2(std::sin(graphic),
                                             transformations_->graphic_per_centric * std::cos(graphic)))};
}

}  // namespace slipway::dem
