#pragma once

#include <memory>
#include <optional>
#include <string>

#include "api/files/terrain_site.h"
#include "api/requests/plan_request.h"
#include "core/result.h"
#include "planner/problem/departure.h"

namespace slipway::api {

// Mean radius of a body by its name in ElevationInfo; infinite where it is not known.
double body_radius_m(const std::string& body);

// How far the map's north stands clockwise of the true one at a place of the map; 0 in a local frame.
double map_north_rad(const TerrainSite& site, double x_m, double y_m);

// Why the directions of sun and Earth over a terrain can't be computed; nothing on Mars.
std::optional<std::string> why_no_sky(const TerrainSite& site);

// How many of the terrain's cells are one of the coarser cells below.
int coarser_step(const dem::GridGeometry& terrain);
// What lies beyond `near`: the whole terrain in coarser cells; null where `near` is all of it. Errors: as of
// TerrainSite::read_samples.
Result<std::shared_ptr<const dem::Terrain>> ground_around(const TerrainSite& site, const dem::Terrain& near);
// The horizon of both. Errors: the same.
Result<std::shared_ptr<const dem::Horizon>> horizon_over(const TerrainSite& site,
                                                         std::shared_ptr<const dem::Terrain> near);

// A request's departure with the sky and the horizon of the terrain, see horizon_over(). `start` is where the
// sky is taken. Errors: as of TerrainSite::read_samples.
Result<std::shared_ptr<const planner::Departure>> departure_of(const TerrainSite& site,
                                                               std::shared_ptr<const dem::Terrain> near,
                                                               const planner::Waypoint& start,
                                                               const DepartureRequest& request);

}  // namespace slipway::api
