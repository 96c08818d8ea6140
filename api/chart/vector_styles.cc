#include "api/chart/vector_styles.h"

#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

namespace slipway::api {
namespace {

constexpr const char* kVectorHead =
    "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
    "<qgis version=\"3.22\" styleCategories=\"Symbology\">\n";

std::string line_symbol(int name, const char* colour, double width_mm) {
  return fmt::format(
      "   <symbol name=\"{}\" type=\"line\" alpha=\"1\"><layer class=\"SimpleLine\" enabled=\"1\">"
      "<prop k=\"line_color\" v=\"{}\"/><prop k=\"line_width\" v=\"{}\"/>"
      "<prop k=\"line_width_unit\" v=\"MM\"/></layer></symbol>\n",
      name, colour, width_mm);
}

std::string point_symbol(int name, const char* colour) {
  return fmt::format(
      "   <symbol name=\"{}\" type=\"marker\" alpha=\"1\"><layer class=\"SimpleMarker\" enabled=\"1\">"
      "<prop k=\"name\" v=\"circle\"/><prop k=\"color\" v=\"{}\"/><prop k=\"outline_style\" v=\"no\"/>"
      "<prop k=\"size\" v=\"1.6\"/><prop k=\"size_unit\" v=\"MM\"/></layer></symbol>\n",
      name, colour);
}

struct ColourRange {
  double from, to;
  const char* colour;
};

constexpr std::array<ColourRange, 5> kRanges{{{-1.0, 0.1, "26,152,80,255"},
                                              {0.1, 0.2, "166,217,106,255"},
                                              {0.2, 0.4, "254,224,139,255"},
                                              {0.4, 0.6, "244,109,67,255"},
                                              {0.6, 1.0, "165,0,38,255"}}};

std::string graduated(const char* attribute, bool lines) {
  std::string ranges, symbols;
  for (std::size_t i = 0; i < kRanges.size(); ++i) {
    const ColourRange& range = kRanges[i];
    ranges += fmt::format(
        "   <range lower=\"{0}\" upper=\"{1}\" symbol=\"{2}\" label=\"{0} to {1}\" "
        "render=\"true\"/>\n",
        range.from, range.to, i);
    symbols += lines ? line_symbol(static_cast<int>(i), range.colour, 1.6)
                     : point_symbol(static_cast<int>(i), range.colour);
  }
  return fmt::format(
      "{} <renderer-v2 type=\"graduatedSymbol\" attr=\"{}\" graduatedMethod=\"GraduatedColor\">\n"
      "  <ranges>\n{}  </ranges>\n  <symbols>\n{}  </symbols>\n </renderer-v2>\n</qgis>\n",
      kVectorHead, attribute, ranges, symbols);
}

}  // namespace

std::string route_style() {
  const std::vector<std::pair<const char*, const char*>> verdicts{
      {"go", "26,152,80,255"}, {"unknown", "253,174,97,255"}, {"no_go", "215,48,39,255"}};
  std::string categories, symbols;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    categories += fmt::format("   <category value=\"{0}\" symbol=\"{1}\" label=\"{0}\" render=\"true\"/>\n",
                              verdicts[i].first, i);
    symbols += line_symbol(static_cast<int>(i), verdicts[i].second, 0.8);
  }
  return fmt::format(
      "{} <renderer-v2 type=\"categorizedSymbol\" attr=\"verdict\">\n  <categories>\n{}  </categories>\n"
      "  <symbols>\n{}  </symbols>\n </renderer-v2>\n</qgis>\n",
      kVectorHead, categories, symbols);
}

std::string station_style() {
  return graduated("slip", false);
}

std::string rule_style() {
  return graduated("trips", true);
}

}  // namespace slipway::api
