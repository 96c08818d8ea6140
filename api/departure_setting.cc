#include "api/departure_setting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/angle.h"
#include "sky/mars_time.h"

namespace slipway::api {
namespace {

// Mean radius and solar day.
struct Body {
  std::string_view name;
  double radius_m, day_s;
};
constexpr Body kBodies[] = {
    {"Mars", 3'389'500.0, sky::kSol_s}, {"Moon", 1'737'400.0, 2'551'442.9}, {"Earth", 6'371'000.0, 86'400.0}};

const Body* body_of(const std::string& name) {
  const auto* const found = std::find_if(std::begin(kBodies), std::end(kBodies),
                                         [&](const Body& each) { return each.name == name; });
  return found == std::end(kBodies) ? nullptr : found;
}

}  // namespace

double body_radius_m(const std::string& body) {
  const Body* const found = body_of(body);
  return found != nullptr ? found->radius_m : std::numeric_limits<double>::infinity();
}

double map_north_rad(const TerrainSite& site, double x_m, double y_m) {
  constexpr double kStep_m = 1.0;
  const auto here = site.degrees_at({x_m, y_m}), north = site.degrees_at({x_m, y_m + kStep_m});
  if (!here || !north) return 0.0;
  // The bearing at which the great circle to the second place begins: right beside a pole, too.
  const double latitude = rad_from_deg(here->y), latitude_north = rad_from_deg(north->y);
  const double east = rad_from_deg(north->x - here->x);
  return std::atan2(std::sin(east) * std::cos(latitude_north),
                    std::cos(latitude) * std::sin(latitude_north) -
                        std::sin(latitude) * std::cos(latitude_north) * std::cos(east));
}

std::optional<std::string> why_no_sky(const TerrainSite& site) {
  const dem::Extent extent = site.info().geometry.extent();
  const dem::MapPlace middle{0.5 * (extent.west_m + extent.east_m), 0.5 * (extent.south_m + extent.north_m)};
  if (site.info().body == "Mars" && site.degrees_at(middle)) return std::nullopt;
  return fmt::format("the terrain lies {}, where the sun's direction is not computed",
                     site.info().body == "Mars" || site.info().body == "other"
                         ? std::string("in a local frame")
                         : "on the " + site.info().body);
}

int coarser_step(const dem::GridGeometry& terrain) {
  constexpr int kMostCells = 1024;  // along a side
  return 1 + (std::max(terrain.rows, terrain.columns) - 1) / kMostCells;
}

Result<std::shared_ptr<const dem::Terrain>> ground_around(const TerrainSite& site, const dem::Terrain& near) {
  const dem::GridGeometry& whole = site.info().geometry;
  // Of a terrain whose cells are read when they are looked at no more than the coarse one is held.
  if (near.geometry() == whole && !near.is_read_by_tiles()) return std::shared_ptr<const dem::Terrain>();
  return site.read_samples(whole.extent(), coarser_step(whole));
}

Result<std::shared_ptr<const dem::Horizon>> horizon_over(const TerrainSite& site,
                                                         std::shared_ptr<const dem::Terrain> near) {
  auto around = ground_around(site, *near);
  if (!around) return fail(around.error());
  return std::make_shared<const dem::Horizon>(std::move(near), body_radius_m(site.info().body),
                                              std::move(*around));
}

Result<std::shared_ptr<const planner::Departure>> departure_of(const TerrainSite& site,
                                                               std::shared_ptr<const dem::Terrain> near,
                                                               const planner::Waypoint& start,
                                                               const DepartureRequest& request) {
  auto departure = std::make_shared<planner::Departure>(request);
  if (const Body* const body = body_of(site.info().body)) departure->day_s = body->day_s;
  if (site.info().body == "Moon" && request.optical_depth > 0.0)
    return fail(ErrorCode::kInvalidRequest, "the Moon has no air",
                {{"/departure/optical_depth", "is of an atmosphere, which the Moon has not: leave it out"}});
  std::shared_ptr<const sky::Sky> sky;
  if (!request.table.empty()) {
    std::vector<sky::SkySample> table = request.table;
    if (site.info().body == "Mars")
      for (sky::SkySample& sample : table)
        sample.sun_distance_au = sky::mars_time(sample.utc_ms, 0.0).sun_distance_au;
    sky = std::make_shared<sky::SkyTable>(std::move(table));
  } else if (auto why = sky::why_not_known(request.from_ms), later = sky::why_not_known(request.to_ms);
             why || later) {
    return fail(ErrorCode::kInvalidRequest, why ? *why : *later,
                {{why ? "/departure/from" : "/departure/to", why ? *why : *later}});
  } else if (const auto degrees = site.degrees_at({start.x_m, start.y_m})) {
    sky = std::make_shared<sky::MarsSky>(rad_from_deg(degrees->x), rad_from_deg(degrees->y));
  } else {
    return fail(ErrorCode::kInvalidRequest, "the start has no longitude and latitude on this map");
  }
  departure->sky =
      std::make_shared<sky::SkyOverMap>(std::move(sky), map_north_rad(site, start.x_m, start.y_m));
  auto horizon = horizon_over(site, std::move(near));
  if (!horizon) return fail(horizon.error());
  departure->horizon = std::move(*horizon);
  return std::shared_ptr<const planner::Departure>(std::move(departure));
}

}  // namespace slipway::api
