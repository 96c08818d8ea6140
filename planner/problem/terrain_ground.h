#pragma once

#include <memory>

#include "dem/soil_map.h"
#include "dem/terrain.h"
#include "sim/rover/ground.h"

namespace slipway::planner {

// A terrain and its soil map as the simulator meets them. Without a soil map all ground is unknown.
class TerrainGround final : public sim::Ground {
 public:
  TerrainGround(std::shared_ptr<const dem::Terrain> terrain, std::shared_ptr<const dem::SoilMap> soil_map);

  std::optional<sim::GroundPoint> at(double x_m, double y_m) const override;
  std::optional<std::size_t> soil_at(double x_m, double y_m) const override;

 private:
  std::shared_ptr<const dem::Terrain> terrain_;
  std::shared_ptr<const dem::SoilMap> soil_map_;
};

}  // namespace slipway::planner
