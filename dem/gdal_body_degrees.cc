#include "dem/gdal_body_degrees.h"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "dem/body_degrees.h"
#include "dem/gdal_crs.h"
#include "dem/gdal_session.h"

namespace slipway::dem {
namespace {

// Where x is on the meridian that the projection is about.
double middle_of(const OGRSpatialReference& map) {
  return map.GetNormProjParm(SRS_PP_FALSE_EASTING, 0.0);
}

}  // namespace

std::optional<double> turn_of(const OGRSpatialReference& map) {
  const std::unique_ptr<OGRSpatialReference> base(map.CloneGeogCS());
  if (map.IsProjected() == 0 || !base) return std::nullopt;
  OGRSpatialReference from(*base), to(map);
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> forward(OGRCreateCoordinateTransformation(&from, &to));
  if (!forward) return std::nullopt;
  const double about = map.GetNormProjParm(SRS_PP_CENTRAL_MERIDIAN, 0.0);
  constexpr std::array<double, 4> kFromMeridian_deg{-120.0, -1.0, 30.0, 150.0};
  std::optional<double> turn;
  for (const double latitude : {-20.0, 0.0, 40.0}) {
    for (const double longitude : kFromMeridian_deg) {
      std::array<double, 2> x{about + longitude, about + longitude + 1.0}, y{latitude, latitude};
      if (forward->Transform(2, x.data(), y.data()) == FALSE) return std::nullopt;
      const double grown = 360.0 * (x[1] - x[0]);
      if (!(grown > 0.0) || (turn && std::abs(grown - *turn) > 1e-6 * *turn)) return std::nullopt;
      turn = turn.value_or(grown);
    }
  }
  return turn;
}

std::unique_ptr<OGRSpatialReference> on_own_sheet(const OGRSpatialReference& map, const Extent& extent) {
  const std::optional<double> turn = turn_of(map);
  if (!turn) return nullptr;
  const double farthest =
      std::max(std::abs(extent.west_m - middle_of(map)), std::abs(extent.east_m - middle_of(map)));
  if (farthest <= 0.5 * *turn) return nullptr;
  const double middle = 0.5 * (extent.west_m + extent.east_m);
  const double moved_deg = 360.0 * (middle - middle_of(map)) / *turn;
  auto own = std::make_unique<OGRSpatialReference>(map);
  own->SetNormProjParm(SRS_PP_CENTRAL_MERIDIAN,
                       std::remainder(map.GetNormProjParm(SRS_PP_CENTRAL_MERIDIAN, 0.0) + moved_deg, 360.0));
  own->SetNormProjParm(SRS_PP_FALSE_EASTING, middle);
  return own;
}

std::vector<std::string> warp_source(GDALDataset& raster) {
  std::array<double, 6> grid{};
  const OGRSpatialReference* const map = raster.GetSpatialRef();
  if (map == nullptr || raster.GetGeoTransform(grid.data()) != CE_None) return {};
  const double across = grid[1] * raster.GetRasterXSize(), along = grid[2] * raster.GetRasterYSize();
  const auto [west, east] =
      std::minmax({grid[0], grid[0] + across, grid[0] + along, grid[0] + across + along});
  const auto own = on_own_sheet(*map, {west, 0.0, east, 0.0});
  if (!own) return {};
  ElevationInfo named;
  describe_crs(*own, named);
  return {"-s_srs", named.crs_wkt};
}

struct BodyDegrees::Transformations {
  std::unique_ptr<OGRCoordinateTransformation> to_map, to_degrees;
  std::optional<double> turn_m;
  double graphic_per_centric = 1.0;  // of the tangents of the latitudes: 1 / (1 - e^2)
};

BodyDegrees::BodyDegrees(const std::string& crs_wkt, const std::string& body,
                         const std::optional<Extent>& extent) {
  const GdalSession session;  // prepares the process, and keeps complaints to itself
  OGRSpatialReference map;
  if (crs_wkt.empty() || map.importFromWkt(crs_wkt.c_str()) != OGRERR_NONE || map.IsProjected() == 0) return;
  auto made = std::make_unique<Transformations>();
  made->turn_m = turn_of(map);
  if (const auto own = extent ? on_own_sheet(map, *extent) : nullptr) map = *own;
  map.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRSpatialReference degrees;
  degrees.SetGeogCS("longitude and latitude", "the elevation's datum", "its ellipsoid", map.GetSemiMajor(),
                    map.GetInvFlattening(), nullptr, map.GetPrimeMeridian());
  degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRCoordinateTransformationOptions options;
  options.SetBallparkAllowed(true);
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

std::optional<double> BodyDegrees::turn_m() const {
  return usable() ? transformations_->turn_m : std::nullopt;
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

std::string likely_mistake(const std::string& crs_wkt, const std::string& body, const Extent& extent,
                           const MapPlace& given, bool in_degrees) {
  const BodyDegrees degrees(crs_wkt, body, extent);
  const MapPlace turned{given.y, given.x};
  const auto on_map = [&](const MapPlace& place) -> std::optional<MapPlace> {
    if (std::abs(place.x) > 720.0 || std::abs(place.y) > 90.0) return std::nullopt;
    const auto found = degrees.to_map(place);
    return found && extent.contains(found->x, found->y) ? found : std::nullopt;
  };
  const auto advice = [](const MapPlace& place) {
    return fmt::format(
        "the map's place is ({:.3f}, {:.3f}) m, and the command line takes degrees with --lonlat", place.x,
        place.y);
  };
  if (in_degrees) {
    if (on_map(turned))
      return fmt::format("; longitude and latitude are swapped: the map has a place {},{}", turned.x,
                         turned.y);
    if (extent.contains(given.x, given.y)) return "; these are map metres";
    if (extent.contains(turned.x, turned.y)) return "; these are map metres, with x and y swapped";
    return {};
  }
  if (extent.contains(turned.x, turned.y))
    return fmt::format("; x and y are swapped: the map has a place ({}, {}) m", turned.x, turned.y);
  if (const auto place = on_map(given))
    return "; these are longitude and latitude in degrees: " + advice(*place);
  if (const auto place = on_map(turned))
    return "; these are latitude and longitude in degrees, in this order: " + advice(*place);
  return {};
}

}  // namespace slipway::dem
