#pragma once

#include <memory>
#include <optional>
#include <string>

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
  // crs_wkt and body: of ElevationInfo.
  BodyDegrees(const std::string& crs_wkt, const std::string& body);
  ~BodyDegrees();
  BodyDegrees(BodyDegrees&&) noexcept;
  BodyDegrees& operator=(BodyDegrees&&) noexcept;

  // False in a local frame, which lies on no body.
  bool usable() const;
  // Nothing where the map does not reach.
  std::optional<MapPlace> to_map(const MapPlace& degrees) const;
  // Longitude in [-180, 180].
  std::optional<MapPlace> to_degrees(const MapPlace& map) const;

 private:
  struct Transformations;
  std::unique_ptr<Transformations> transformations_;
};

}  // namespace slipway::dem
