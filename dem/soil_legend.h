#pragma once

#include <string>
#include <vector>

#include "dem/soil_map.h"

namespace slipway::dem {

// Values or labels that occur twice in a legend, as faults at "/legend/3/value" or "/legend/3/label". A
// raster is matched by values, polygons by labels.
std::vector<Fault> repeated_values(const std::vector<SoilClass>& legend);
std::vector<Fault> repeated_labels(const std::vector<SoilClass>& legend);

// How much of a map the rows of its legend cover, for a person to check.
struct SoilCover {
  std::vector<std::string> lines;     // "unit plain covers 12.3 % of the map"
  std::vector<std::string> warnings;  // of rows that cover nothing or everything
  bool is_empty = true;               // nothing of the map is covered
};

// `word`: what a row of the legend is called, "unit" or "class". ground: of the elevation.
SoilCover cover_of(const SoilMap& map, const Extent& ground, const std::string& word);

}  // namespace slipway::dem
