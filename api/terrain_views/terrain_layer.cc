#include "api/terrain_views/terrain_layer.h"

#include <fmt/format.h>

#include <algorithm>

namespace slipway::api {
namespace {

constexpr std::array<dem::Rgba, 8> kSoilPalette{{{0x00, 0x72, 0xb2, 0xff},
                                                 {0xe6, 0x9f, 0x00, 0xff},
                                                 {0x00, 0x9e, 0x73, 0xff},
                                                 {0xcc, 0x79, 0xa7, 0xff},
                                                 {0x56, 0xb4, 0xe9, 0xff},
                                                 {0xd5, 0x5e, 0x00, 0xff},
                                                 {0xf0, 0xe4, 0x42, 0xff},
                                                 {0x7a, 0x5c, 0x3e, 0xff}}};

std::vector<LayerLegendEntry> slope_legend() {
  std::vector<LayerLegendEntry> entries;
  double from = 0.0;
  for (const SlopeClass& each : kSlopeClasses) {
    const bool last = &each == &kSlopeClasses.back();
    entries.push_back(
        {last ? fmt::format("above {:g}", from) : fmt::format("{:g} to {:g}", from, each.below_deg),
         each.colour});
    from = each.below_deg;
  }
  entries.push_back({"no elevation", std::nullopt});
  return entries;
}

}  // namespace

const TerrainLayerRow* find_terrain_layer(std::string_view name) {
  const auto* const found = std::find_if(kTerrainLayers.begin(), kTerrainLayers.end(),
                                         [&](const TerrainLayerRow& row) { return row.name == name; });
  return found == kTerrainLayers.end() ? nullptr : found;
}

dem::Rgba slope_colour(double slope_deg) {
  for (const SlopeClass& each : kSlopeClasses)
    if (slope_deg < each.below_deg) return each.colour;
  return kSlopeClasses.back().colour;
}

dem::Rgba soil_colour(std::size_t k) {
  return kSoilPalette[k % kSoilPalette.size()];
}

std::vector<std::string> soils_of(const Legend& legend) {
  std::vector<std::string> soils;
  for (const dem::SoilClass& each : legend.classes)
    if (each.soil && std::find(soils.begin(), soils.end(), *each.soil) == soils.end())
      soils.push_back(*each.soil);
  return soils;
}

std::vector<LayerLegendEntry> legend_of(const TerrainLayerRow& layer, const Legend& soils) {
  if (layer.layer == TerrainLayer::kHillshade) return {};
  if (layer.layer == TerrainLayer::kSlope) return slope_legend();
  std::vector<LayerLegendEntry> entries;
  if (layer.layer == TerrainLayer::kSoil) {
    const std::vector<std::string> names = soils_of(soils);
    for (std::size_t k = 0; k < names.size(); ++k) entries.push_back({names[k], soil_colour(k)});
  }
  entries.push_back({"unknown ground", std::nullopt});
  return entries;
}

}  // namespace slipway::api
