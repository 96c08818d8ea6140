#include "api/place_sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "api/departure_setting.h"
#include "api/sunlight.h"
#include "core/angle.h"
#include "core/utc.h"
#include "dem/horizon/horizon.h"
#include "sky/sky.h"

namespace slipway::api {
namespace {

constexpr double kSol_ms = 1000.0 * sky::kSol_s;

// The local midnight of true solar time that is nearest to a time. A true sol is some seconds longer or
// shorter than the mean one.
std::int64_t midnight_near(double utc_ms, double east_longitude_rad) {
  constexpr int kTimes = 3;
  for (int k = 0; k < kTimes; ++k) {
    const double hours = sky::mars_time(std::llround(utc_ms), east_longitude_rad).true_solar_h;
    utc_ms -= (hours > 12.0 ? hours - 24.0 : hours) / 24.0 * kSol_ms;
  }
  return std::llround(utc_ms);
}

std::vector<Fault> faults_of(const dem::Extent& map, double x_m, double y_m, std::int64_t from_ms,
                             std::optional<std::int64_t> to_ms) {
  std::vector<Fault> faults;
  if (!map.contains(x_m, y_m))
    faults.push_back(
        {"/place",
         fmt::format("({:.10g}, {:.10g}) m is off the map, must be in x [{}, {}] m and y [{}, {}] m", x_m,
                     y_m, map.west_m, map.east_m, map.south_m, map.north_m)});
  if (auto why = sky::why_not_known(from_ms)) faults.push_back({"/from", *std::move(why)});
  if (to_ms)
    if (auto why = sky::why_not_known(*to_ms)) faults.push_back({"/to", *std::move(why)});
  return faults;
}

}  // namespace

void write_bearing(json::Writer& w, std::string_view key, const sky::Bearing& bearing) {
  w.key(key).begin_object().significant("azimuth_deg", deg_from_rad(bearing.azimuth_rad));
  w.significant("elevation_deg", deg_from_rad(bearing.elevation_rad)).end_object();
}

SkyMoment sky_moment(std::int64_t utc_ms, const dem::MapPlace& degrees, double map_north_rad) {
  const double east = rad_from_deg(degrees.x), north = rad_from_deg(degrees.y);
  const sky::SkyOverMap sky(std::make_shared<sky::MarsSky>(east, north), map_north_rad);
  return {utc_ms, sky::mars_time(utc_ms, east), sky.sun(utc_ms).value(), sky.earth(utc_ms).value()};
}

void write_sky_moment(json::Writer& w, const SkyMoment& moment) {
  const sky::MarsTime& time = moment.time;
  w.exact("sol_date", time.sol_date).exact("solar_longitude_deg", deg_from_rad(time.season_rad));
  w.exact("mean_solar_h", time.mean_solar_h).exact("true_solar_h", time.true_solar_h);
  w.significant("declination_deg", deg_from_rad(time.declination_rad));
  w.significant("sun_distance_au", time.sun_distance_au);
  write_bearing(w, "sun", moment.sun);
  write_bearing(w, "earth", moment.earth);
}

Result<PlaceSky> sky_over(const TerrainSite& site, double x_m, double y_m, std::int64_t from_ms,
                          std::optional<std::int64_t> to_ms) {
  if (auto why = why_no_sky(site)) return fail(ErrorCode::kInvalidRequest, *why, {{"/name", *why}});
  const dem::GridGeometry& geometry = site.info().geometry;
  if (auto faults = faults_of(geometry.extent(), x_m, y_m, from_ms, to_ms); !faults.empty())
    return fail(geometry.extent().contains(x_m, y_m) ? ErrorCode::kInvalidRequest : ErrorCode::kOffMap,
                "There is no sky over this place at this time.", std::move(faults));
  const auto degrees = site.degrees_at({x_m, y_m});
  if (!degrees)
    return fail(ErrorCode::kInvalidRequest, "The place has no longitude and latitude.",
                {{"/place", "has no longitude and latitude on this map"}});
  if (!to_ms) {
    const double east = rad_from_deg(degrees->x);
    const double since_h = sky::mars_time(from_ms, east).true_solar_h;
    from_ms = midnight_near(static_cast<double>(from_ms) - since_h / 24.0 * kSol_ms, east);
    to_ms = midnight_near(static_cast<double>(from_ms) + kSol_ms, east);
  }
  constexpr double kReach_cells = 128.0;  // around the place in the terrain's own cells
  const double reach_m = kReach_cells * std::max(geometry.cell_x_m, geometry.cell_y_m);
  auto near = ground_of(site, {x_m - reach_m, y_m - reach_m, x_m + reach_m, y_m + reach_m});
  if (!near) return fail(near.error());
  const auto horizon = horizon_over(site, std::move(*near));
  if (!horizon) return fail(horizon.error());
  PlaceSky sky{x_m, y_m, *degrees, {}};
  const double north = map_north_rad(site, x_m, y_m);
  const double span_ms = static_cast<double>(*to_ms - from_ms);
  constexpr double kMostApart_ms = 900'000.0;
  const int steps = std::max(1, static_cast<int>(std::ceil(span_ms / kMostApart_ms)));
  for (int k = 0; k <= steps && (k == 0 || span_ms > 0.0); ++k) {
    PlaceSky::Seen seen{sky_moment(from_ms + std::llround(span_ms * k / steps), *degrees, north)};
    const auto horizon_rad = (*horizon)->elevation_rad(x_m, y_m, 0.0, seen.moment.sun.azimuth_rad);
    if (!horizon_rad)
      return fail(
          ErrorCode::kNoData, "There is no ground.",
          {{"/place",
            fmt::format("({:.10g}, {:.10g}) m has no height: the terrain is not known there", x_m, y_m)}});
    seen.horizon_rad = std::max(0.0, *horizon_rad);
    seen.is_lit = seen.moment.sun.elevation_rad > seen.horizon_rad;
    sky.moments.push_back(seen);
  }
  return sky;
}

std::string write_place_sky(const TerrainSite& site, const PlaceSky& sky) {
  json::Writer w;
  w.begin_object().text("terrain", site.description().name).metres("x_m", sky.x_m).metres("y_m", sky.y_m);
  w.significant("longitude_deg", sky.degrees.x).significant("latitude_deg", sky.degrees.y);
  w.key("moments").begin_array();
  for (const PlaceSky::Seen& seen : sky.moments) {
    w.begin_object().text("at", utc_text(seen.moment.utc_ms));
    write_sky_moment(w, seen.moment);
    w.significant("horizon_deg", deg_from_rad(seen.horizon_rad)).boolean("lit", seen.is_lit).end_object();
  }
  w.end_array().end_object();
  return w.take();
}

}  // namespace slipway::api
