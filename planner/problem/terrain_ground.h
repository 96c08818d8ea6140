#pragma once

#include <memory>
#include <vector>

#include "dem/soil_map.h"
#include "dem/terrain.h"
#include "sim/rover/ground.h"

namespace slipway::planner {

// A terrain and its soil map as the simulator meets them. Without a soil map all ground is unknown.
class TerrainGround final : public sim::Ground {
 public:
  // `soils`: for each of soil_map->soils() which of another list's it is; empty: that list is the map's own.
  TerrainGround(std::shared_ptr<const dem::Terrain> terrain, std::shared_ptr<const dem::SoilMap> soil_map,
                std::vector<std::size_t> soils = {});
  // One soil everywhere.
  TerrainGround(std::shared_ptr<const dem::Terrain> terrain, std::size_t soil);

  std::optional<sim::GroundPoint> at(double x_m, double y_m) const override;
  std::optional<std::size_t> soil_at(double x_m, double y_m) const override;

 private:
  std::shared_ptr<const dem::Terrain> terrain_;
  std::shared_ptr<const dem::SoilMap> soil_map_;
  std::vector<std::size_t> soils_;
};

}  // namespace slipway::planner
