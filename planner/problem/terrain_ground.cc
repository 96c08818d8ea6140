#include "planner/problem/terrain_ground.h"

#include <utility>

namespace slipway::planner {

TerrainGround::TerrainGround(std::shared_ptr<const dem::Terrain> terrain,
                             std::shared_ptr<const dem::SoilMap> soil_map, std::vector<std::size_t> soils)
    : terrain_(std::move(terrain)), soil_map_(std::move(soil_map)), soils_(std::move(soils)) {}

TerrainGround::TerrainGround(std::shared_ptr<const dem::Terrain> terrain, std::size_t soil)
    : terrain_(std::move(terrain)), soils_{soil} {}

std::optional<sim::GroundPoint> TerrainGround::at(double x_m, double y_m) const {
  const std::optional<dem::SurfacePoint> point = terrain_->surface(x_m, y_m);
  if (!point) return std::nullopt;
  return sim::GroundPoint{.height_m = point->height_m, .normal = point->normal};
}

std::optional<std::size_t> TerrainGround::soil_at(double x_m, double y_m) const {
  if (!soil_map_) return soils_.empty() ? std::nullopt : std::optional(soils_.front());
  const std::optional<std::size_t> soil = soil_map_->soil_at(x_m, y_m);
  return soil && !soils_.empty() ? soils_[*soil] : soil;
}

}  // namespace slipway::planner
