#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "api/files/terrain_site.h"
#include "core/result.h"

namespace slipway::api {

constexpr std::size_t kMaxProfileCorners = 500;
constexpr std::size_t kMaxProfilePoints = 5000;

// The ground under a place of a line; empty where the map has nothing.
struct ProfilePoint {
  double distance_m = 0.0, x_m = 0.0, y_m = 0.0;
  std::optional<double> height_m, slope_rad;
  std::optional<std::string> label, soil;  // empty soil: unknown ground
};

// So many places, at equal distances along straight lines between the corners, from the first to the last.
// corners: 2 or more; points: 2 or more. Errors: not_found (the legend), those of dem::ElevationSource.
Result<std::vector<ProfilePoint>> ground_along(const TerrainSite& site,
                                               const std::vector<Eigen::Vector2d>& corners,
                                               std::size_t points, const std::string& legend);

// {"terrain", "legend", "count", "distance_m": [...], ...}.
std::string write_profile(const TerrainSite& site, const std::string& legend,
                          const std::vector<ProfilePoint>& points);

}  // namespace slipway::api
