#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/files/terrain_site.h"
#include "api/json/writer.h"
#include "core/result.h"
#include "dem/body_degrees.h"
#include "sky/bearing.h"
#include "sky/mars_time.h"

// What stands in the sky over a place on Mars.
namespace slipway::api {

struct SkyMoment {
  std::int64_t utc_ms = 0;
  sky::MarsTime time;
  sky::Bearing sun, earth;
};

// Over a place in degrees. Azimuths count from a north that stands `map_north_rad` clockwise of the true one.
SkyMoment sky_moment(std::int64_t utc_ms, const dem::MapPlace& degrees, double map_north_rad = 0.0);
void write_bearing(json::Writer& w, std::string_view key, const sky::Bearing& bearing);
// Its keys after "at", into an object that is open.
void write_sky_moment(json::Writer& w, const SkyMoment& moment);

// Over a place of a terrain's map, with what the ground hides from there.
struct PlaceSky {
  double x_m = 0.0, y_m = 0.0;
  dem::MapPlace degrees;
  struct Seen {
    SkyMoment moment;
    double horizon_rad = 0.0;  // of the ground below the sun; 0 where that lies below the level
    bool is_lit = false;
  };
  std::vector<Seen> moments;  // azimuths from the map's north
};
constexpr double kMostSky_h = 50.0;

// From one time to another, at equal distances of at most 15 minutes; without `to_ms` over the sol of local
// true solar time that `from_ms` lies in, from midnight to midnight. Errors: off_map; no_data;
// invalid_request where the sky is not computed; those of TerrainSite::read_samples.
Result<PlaceSky> sky_over(const TerrainSite& site, double x_m, double y_m, std::int64_t from_ms,
                          std::optional<std::int64_t> to_ms);
std::string write_place_sky(const TerrainSite& site, const PlaceSky& sky);

}  // namespace slipway::api
