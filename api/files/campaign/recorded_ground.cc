#include "api/files/campaign/recorded_ground.h"

#include <utility>

namespace slipway::api {

RecordedGround::RecordedGround(std::shared_ptr<const dem::Terrain> terrain, std::size_t soil)
    : terrain_(std::move(terrain)), soils_{soil} {}

RecordedGround::RecordedGround(std::shared_ptr<const dem::Terrain> terrain,
                               std::shared_ptr<const dem::SoilMap> soil_map, std::vector<std::size_t> soils)
    : terrain_(std::move(terrain)), soil_map_(std::move(soil_map)), soils_(std::move(soils)) {}

std::optional<sim::GroundPoint> RecordedGround::at(double x_m, double y_m) const {
  const std::optional<dem::SurfacePoint> point = terrain_->surface(x_m, y_m);
  if (!point) return std::nullopt;
  return sim::GroundPoint{.height_m = point->height_m, .normal = point->normal};
}

std::optional<std::size_t> RecordedGround::soil_at(double x_m, double y_m) const {
  if (!soil_map_) return soils_[0];
  const std::optional<std::size_t> soil = soil_map_->soil_at(x_m, y_m);
  if (!soil) return std::nullopt;
  return soils_[*soil];
}

}  // namespace slipway::api
