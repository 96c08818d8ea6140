#include <fmt/format.h>

#include <array>
#include <string>

#include "api/chart/chart.h"
#include "api/maps/map_layer.h"

namespace slipway::api {
namespace {

std::string colour_text(const std::array<std::uint8_t, 3>& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

constexpr const char* kStyleHead =
    "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
    "<qgis version=\"3.22\" styleCategories=\"Symbology\">\n <pipe>\n";
constexpr const char* kStyleTail = " </pipe>\n</qgis>\n";

std::string paletted(const dem::RasterLayer& layer) {
  std::string out =
      "  <rasterrenderer type=\"paletted\" band=\"1\" opacity=\"1\" alphaBand=\"-1\">\n"
      "   <colorPalette>\n";
  for (const dem::RasterClass& each : layer.classes)
    out += fmt::format("    <paletteEntry value=\"{}\" color=\"{}\" alpha=\"255\" label=\"{}\"/>\n",
                       each.value, colour_text(each.colour), xml_text(each.name));
  return out + "   </colorPalette>\n  </rasterrenderer>\n";
}

// From green over yellow to red: a greater value is a worse one.
std::string colour_ramp(double lowest, double highest) {
  constexpr std::array<std::array<std::uint8_t, 3>, 5> kColours{
      {{26, 152, 80}, {166, 217, 106}, {254, 224, 139}, {244, 109, 67}, {165, 0, 38}}};
  std::string out = fmt::format(
      "  <rasterrenderer type=\"singlebandpseudocolor\" band=\"1\" opacity=\"1\" alphaBand=\"-1\" "
      "classificationMin=\"{0:.9g}\" classificationMax=\"{1:.9g}\">\n   <rastershader>\n"
      "    <colorrampshader colorRampType=\"INTERPOLATED\" classificationMode=\"1\" clip=\"0\" "
      "minimumValue=\"{0:.9g}\" maximumValue=\"{1:.9g}\">\n",
      lowest, highest);
  for (std::size_t i = 0; i < kColours.size(); ++i) {
    const double value = lowest + (highest - lowest) * static_cast<double>(i) / (kColours.size() - 1);
    out += fmt::format("     <item value=\"{0:.9g}\" label=\"{0:.3g}\" color=\"{1}\" alpha=\"255\"/>\n",
                       value, colour_text(kColours[i]));
  }
  return out + "    </colorrampshader>\n   </rastershader>\n  </rasterrenderer>\n";
}

}  // namespace

std::string map_style(const dem::RasterLayer& layer, const MapStatistics& statistics) {
  if (layer.of_classes) return kStyleHead + paletted(layer) + kStyleTail;
  // Ratios have the same colours on all maps.
  const bool of_cost = !layer.metadata.empty() && layer.metadata.back().first == "SLIPWAY_COST";
  return kStyleHead +
         (of_cost ? colour_ramp(0.0, statistics.highest > 0.0 ? statistics.highest : 1.0)
                  : colour_ramp(0.0, 1.0)) +
         kStyleTail;
}

std::string map_categories(const dem::RasterLayer& layer) {
  if (!layer.of_classes) return {};
  int highest = 0;
  for (const dem::RasterClass& each : layer.classes) highest = std::max<int>(highest, each.value);
  std::string out = "<PAMDataset>\n  <PAMRasterBand band=\"1\">\n    <CategoryNames>\n";
  for (int value = 0; value <= highest; ++value) {
    std::string name;
    for (const dem::RasterClass& each : layer.classes)
      if (each.value == value) name = each.name;
    out += fmt::format("      <Category>{}</Category>\n", xml_text(name));
  }
  return out + "    </CategoryNames>\n  </PAMRasterBand>\n</PAMDataset>\n";
}

}  // namespace slipway::api
