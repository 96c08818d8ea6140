#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/files/terrain_description.h"
#include "dem/write/rgba_image.h"

// What pictures of a terrain show, in which colours.
namespace slipway::api {

enum class TerrainLayer { kHillshade, kSlope, kSoil, kUnknown };

struct TerrainLayerRow {
  TerrainLayer layer = TerrainLayer::kHillshade;
  std::string_view name;   // in addresses
  std::string_view title;  // for people
  std::string_view unit;   // of its legend; "" where it has none
  bool of_soil = false;    // drawn from the soil map, by a legend of the terrain's
};
inline constexpr std::array<TerrainLayerRow, 4> kTerrainLayers{
    {{TerrainLayer::kHillshade, "hillshade", "Shaded relief, the sun in the north-west", ""},
     {TerrainLayer::kSlope, "slope", "Slope", "deg"},
     {TerrainLayer::kSoil, "soil", "Assumed soil", "", true},
     {TerrainLayer::kUnknown, "unknown", "Unknown ground", "", true}}};
// Nothing where there is none of this name.
const TerrainLayerRow* find_terrain_layer(std::string_view name);

// Slopes below this (deg) have this colour; the last one those above too.
struct SlopeClass {
  double below_deg = 0.0;
  dem::Rgba colour;
};
// From pale yellow to dark brown [ColorBrewer YlOrBr]: apart by lightness, for colour-blind eyes as well.
inline constexpr std::array<SlopeClass, 7> kSlopeClasses{{{5.0, {0xff, 0xff, 0xd4, 0xff}},
                                                          {10.0, {0xfe, 0xe3, 0x91, 0xff}},
                                                          {15.0, {0xfe, 0xc4, 0x4f, 0xff}},
                                                          {20.0, {0xfe, 0x99, 0x29, 0xff}},
                                                          {25.0, {0xec, 0x70, 0x14, 0xff}},
                                                          {30.0, {0xcc, 0x4c, 0x02, 0xff}},
                                                          {90.0, {0x8c, 0x2d, 0x04, 0xff}}}};
dem::Rgba slope_colour(double slope_deg);
// Of the k-th soil of a legend [Okabe and Ito 2008]; beyond eight they begin again.
dem::Rgba soil_colour(std::size_t k);
// The soils that a legend names, each once, in its order: what soil_colour counts.
std::vector<std::string> soils_of(const Legend& legend);

// What is not known is hatched, so that it never looks like a value.
inline constexpr dem::Rgba kHatchStripe{0x20, 0x20, 0x20, 0xd0};
inline constexpr dem::Rgba kHatchGround{0xff, 0xff, 0xff, 0x60};
constexpr dem::Rgba hatch(int row, int column) {
  constexpr int kPeriod = 8, kStripe = 3;  // a tile of 256 pixels has whole periods
  return (row + column) % kPeriod < kStripe ? kHatchStripe : kHatchGround;
}

// One entry of a layer's legend; without a colour it is the hatching.
struct LayerLegendEntry {
  std::string label;
  std::optional<dem::Rgba> colour;
};
std::vector<LayerLegendEntry> legend_of(const TerrainLayerRow& layer, const Legend& soils);

}  // namespace slipway::api
