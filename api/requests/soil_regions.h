#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dem/soil_map.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::api {

// A soil of the catalogue in the parts of the map that lie in the same regions of effects.
struct RegionalSoil {
  std::string base;                  // name in the catalogue
  std::vector<std::size_t> regions;  // indices into the effects' regions; empty outside all regions
  bool is_mapped = true;             // otherwise no map names it: it is what is assumed of unknown ground

  // "jlu_mars_2_dense" or "jlu_mars_2_dense@place_1".
  std::string name() const;
};

struct RegionalSoils {
  std::shared_ptr<const dem::SoilMap> map;
  std::vector<RegionalSoil> soils;  // in the order of map->soils()
};

// Makes a soil map on which the cells whose centres lie in a region have a soil of their own, so that search,
// tables and simulation all use it. Unknown ground in a region gets such a soil too, of the one that is
// assumed of it. Without regions the map is returned unchanged.
RegionalSoils soils_in_regions(const std::shared_ptr<const dem::SoilMap>& map,
                               const std::vector<sim::Disc>& regions, const std::string& unknown_soil);

}  // namespace slipway::api
