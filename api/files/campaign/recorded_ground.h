#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "dem/soil_map.h"
#include "dem/terrain.h"
#include "sim/rover/ground.h"

namespace slipway::api {

// The ground of recorded drives: one soil everywhere, or that of a map's class. Its soils are indices into
// the campaign's list.
class RecordedGround final : public sim::Ground {
 public:
  RecordedGround(std::shared_ptr<const dem::Terrain> terrain, std::size_t soil);
  // soils: for each of soil_map->soils(), which of the campaign's it is.
  RecordedGround(std::shared_ptr<const dem::Terrain> terrain, std::shared_ptr<const dem::SoilMap> soil_map,
                 std::vector<std::size_t> soils);

  std::optional<sim::GroundPoint> at(double x_m, double y_m) const override;
  std::optional<std::size_t> soil_at(double x_m, double y_m) const override;

 private:
  std::shared_ptr<const dem::Terrain> terrain_;
  std::shared_ptr<const dem::SoilMap> soil_map_;  // nullptr: soils_[0] everywhere
  std::vector<std::size_t> soils_;
};

}  // namespace slipway::api
