#pragma once

#include <memory>
#include <optional>
#include <string>

#include "dem/grid_geometry.h"

namespace slipway::dem {

// A place on a map (m) or on a body (degrees): x is east or the longitude, y is north or the latitude.
struct MapPlace {
  double x = 0.0;
  double y = 0.0;
};

// Between a terrain's map and longitude and latitude of its body, on the map's own datum. Longitude counts to
// the east. Latitude is planetocentric, as the maps of other worlds are; on the Earth it is geodetic [RFC
// 7946]; on a sphere both are the same. Not thread-safe.
class BodyDegrees {
 public:
  // crs_wkt and body: of ElevationInfo. extent: of its geometry; where longitudes go on beyond half a turn on
  // the map, as x of 226.5 deg does, a place gets the x that the map has for it. Without one it gets the
  // projection's own.
  BodyDegrees(const std::string& crs_wkt, const std::string& body,
              const std::optional<Extent>& extent = std::nullopt);
  ~BodyDegrees();
  BodyDegrees(BodyDegrees&&) noexcept;
  BodyDegrees& operator=(BodyDegrees&&) noexcept;

  // False in a local frame, which lies on no body.
  bool usable() const;
  // Metres of x for 360 deg of longitude where x grows evenly with it (cylindrical maps).
  std::optional<double> turn_m() const;
  // Any longitude: 354.47 and -5.53 are one place. Nothing where the map does not reach.
  std::optional<MapPlace> to_map(const MapPlace& degrees) const;
  // Longitude in [-180, 180].
  std::optional<MapPlace> to_degrees(const MapPlace& map) const;

 private:
  struct Transformations;
  std::unique_ptr<Transformations> transformations_;
};

// What was probably meant by a place that is off the map, as "; longitude and latitude are swapped: ...";
// empty where nothing is likely. crs_wkt and body: as above; in_degrees: the place was given as longitude and
// latitude, else as metres.
std::string likely_mistake(const std::string& crs_wkt, const std::string& body, const Extent& extent,
                           const MapPlace& given, bool in_degrees);

}  // namespace slipway::dem
