#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dem/soil_map.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::api {

// A soil of the catalogue, as it lies in some regions of effects.
struct RegionalSoil {
  std::string base;                  // name in the catalogue
  std::vector<std::size_t> regions;  // indices into the effects' regions; empty: in none

  // "jlu_mars_2_dense" or "jlu_mars_2_dense@place_1".
  std::string name() const;
};

struct RegionalSoils {
  std::shared_ptr<const dem::SoilMap> map;
  std::vector<RegionalSoil> soils;  // in the order of map->soils()
};

// A soil map on which the cells whose centres lie in a region hold a soil of their own, so that search,
// tables and simulation all see it. Unknown ground in a region is ground that is known to be such a place.
// Without regions the map itself.
RegionalSoils soils_in_regions(std::shared_ptr<const dem::SoilMap> map,
                               const std::vector<sim::Disc>& regions);

}  // namespace slipway::api
