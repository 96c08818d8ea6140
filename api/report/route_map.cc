#include "api/report/route_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "api/chart/base64.h"
#include "api/chart/chart.h"
#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/report/thinned_ground.h"
#include "api/report/value_palette.h"
#include "core/angle.h"
#include "dem/write/hillshade.h"

namespace slipway::api {
namespace {

using json::JsonValue;
using json::numbers;

constexpr double kMapWidth_px = 900.0;
constexpr double kLegendWidth_px = 290.0;
constexpr double kMargin_m = 25.0;
constexpr double kSunAzimuth_rad = rad_from_deg(315.0);
constexpr double kSunElevation_rad = rad_from_deg(40.0);
constexpr double kExaggeration = 1.5;

struct ValueColour {
  double below;
  const char* colour;
  const char* words;
};
constexpr std::array kSlipColours{
    ValueColour{0.1, kValuePalette[0], "slip below 0.1"}, ValueColour{0.2, kValuePalette[1], "0.1 to 0.2"},
    ValueColour{0.4, kValuePalette[2], "0.2 to 0.4"}, ValueColour{0.6, kValuePalette[3], "0.4 to 0.6"},
    ValueColour{10.0, kValuePalette[4], "above 0.6"}};
// Of the stops and embeddings that are expected on a stretch.
constexpr std::array kOutcomeColours{
    ValueColour{0.001, kValuePalette[0], "stops or embeddings below 0.001"},
    ValueColour{0.01, kValuePalette[1], "0.001 to 0.01"}, ValueColour{0.1, kValuePalette[2], "0.01 to 0.1"},
    ValueColour{0.5, kValuePalette[3], "0.1 to 0.5"}, ValueColour{1e9, kValuePalette[4], "above 0.5"}};
constexpr std::array kSoilColours{"#377eb8", "#984ea3", "#a65628", "#f781bf",
                                  "#66c2a5", "#e5c494", "#8da0cb", "#ffd92f"};

std::size_t class_of(std::span<const ValueColour> colours, double value) {
  std::size_t k = 0;
  while (k + 1 < colours.size() && std::abs(value) >= colours[k].below) ++k;
  return k;
}

// One route as the document has it.
struct DrawnRoute {
  std::string rank, verdict;
  std::vector<double> distance_m, x_m, y_m, slip;
  std::vector<double> value;  // that its line's colour shows
  std::vector<bool> unknown;
};

std::vector<DrawnRoute> routes_of(const JsonValue& document) {
  std::vector<DrawnRoute> routes;
  const JsonValue* collection = document.find("routes");
  const JsonValue* features = collection ? collection->find("features") : nullptr;
  if (!features) return routes;
  for (const JsonValue& feature : features->elements) {
    const JsonValue* properties = feature.find("properties");
    const JsonValue* stations = properties ? properties->find("stations") : nullptr;
    if (!stations) continue;
    DrawnRoute route;
    const JsonValue* rank = properties->find("rank");
    const JsonValue* verdict = properties->find("verdict");
    route.rank = rank ? fmt::format("{:.0f}", rank->number) : "";
    route.verdict = verdict ? verdict->text : "";
    route.x_m = numbers(*stations, "x_m");
    route.y_m = numbers(*stations, "y_m");
    route.distance_m = numbers(*stations, "distance_m");
    route.slip = numbers(*stations, "slip");
    route.value = route.slip;
    if (const JsonValue* unknown = stations->find("on_unknown_ground"))
      for (const JsonValue& value : unknown->elements) route.unknown.push_back(value.boolean);
    const std::size_t n = std::min({route.distance_m.size(), route.x_m.size(), route.y_m.size(),
                                    route.slip.size(), route.unknown.size()});
    if (n >= 2) routes.push_back(std::move(route));
  }
  return routes;
}

dem::Extent extent_of(const std::vector<DrawnRoute>& routes) {
  dem::Extent e{1e300, 1e300, -1e300, -1e300};
  for (const DrawnRoute& route : routes) {
    const auto [west, east] = std::minmax_element(route.x_m.begin(), route.x_m.end());
    const auto [south, north] = std::minmax_element(route.y_m.begin(), route.y_m.end());
    e = {std::min(e.west_m, *west), std::min(e.south_m, *south), std::max(e.east_m, *east),
         std::max(e.north_m, *north)};
  }
  return {e.west_m - kMargin_m, e.south_m - kMargin_m, e.east_m + kMargin_m, e.north_m + kMargin_m};
}

// A title's words in lines that fit the legend.
std::vector<std::string> in_lines(std::string_view title) {
  constexpr std::size_t kMostLetters = 33;
  std::vector<std::string> lines(1);
  for (std::size_t begin = 0; begin < title.size();) {
    const std::size_t end = std::min(title.find(' ', begin), title.size());
    const std::string_view word = title.substr(begin, end - begin);
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > kMostLetters) lines.emplace_back();
    if (!lines.back().empty()) lines.back() += ' ';
    lines.back() += word;
    begin = end + 1;
  }
  return lines;
}

class Picture {
 public:
  // The routes' lines have the colours of their values.
  Picture(const GroundWindow& ground, std::span<const ValueColour> colours)
      : ground_(ground), colours_(colours), extent_(ground.terrain->geometry().extent()) {
    scale_ = kMapWidth_px / (extent_.east_m - extent_.west_m);
    height_px_ = scale_ * (extent_.north_m - extent_.south_m);
  }

  Result<void> draw_ground() {
    const dem::GridGeometry& grid = ground_.terrain->geometry();
    const auto png =
        dem::encode_png(dem::hillshade(*ground_.terrain, kSunAzimuth_rad, kSunElevation_rad, kExaggeration),
                        grid.rows, grid.columns);
    if (!png) return fail(png.error());
    out_ += fmt::format(
        "<image x=\"0\" y=\"0\" width=\"{:.2f}\" height=\"{:.2f}\" preserveAspectRatio=\"none\" "
        "href=\"data:image/png;base64,{}\"/>\n",
        kMapWidth_px, height_px_, base64(*png));
    return {};
  }

  // Each soil's cells as runs along the rows of the soil map.
  void draw_soils() {
    if (!ground_.soil_map) return;
    const dem::GridGeometry& grid = ground_.soil_map->geometry();
    for (std::size_t soil = 0; soil < ground_.soil_map->soils().size(); ++soil) {
      std::string path;
      for (int row = 0; row < grid.rows; ++row) {
        int begin = -1;
        for (int column = 0; column <= grid.columns; ++column) {
          const Eigen::Vector2d c = grid.centre_m({row, column});
          const bool here = column < grid.columns && ground_.soil_map->soil_at(c.x(), c.y()) == soil;
          if (here && begin < 0) begin = column;
          if (!here && begin >= 0) {
            const Eigen::Vector2d corner =
                grid.centre_m({row, begin}) + Eigen::Vector2d(-0.5 * grid.cell_x_m, 0.5 * grid.cell_y_m);
            path += fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.1f}h{:.1f}z", x(corner.x()), y(corner.y()),
                                scale_ * grid.cell_x_m * (column - begin), scale_ * grid.cell_y_m,
                                -scale_ * grid.cell_x_m * (column - begin));
            begin = -1;
          }
        }
      }
      if (path.empty()) continue;
      const char* colour = kSoilColours[soil % kSoilColours.size()];
      out_ += fmt::format("<path d=\"{}\" fill=\"{}\" fill-opacity=\"0.28\"/>\n", path, colour);
      legend_.push_back({colour, ground_.soil_map->soils()[soil], 0.45});
    }
  }

  // The request's keep-outs, and the edges of its keep-ins.
  void draw_zones(const JsonValue& request) {
    const auto draw = [&](std::string_view key, const char* look) {
      for (const JsonValue& ring : json::at(request, key).elements) {
        out_ += fmt::format("<polygon {} points=\"", look);
        for (const JsonValue& corner : ring.elements)
          out_ += fmt::format("{:.1f},{:.1f} ", x(corner.elements[0].number), y(corner.elements[1].number));
        out_ += "\"/>\n";
      }
    };
    has_keep_out_ = !json::at(request, "keep_out").elements.empty();
    has_keep_in_ = !json::at(request, "keep_in").elements.empty();
    if (!has_keep_out_ && !has_keep_in_) return;
    // What leaves the map is cut off at its edges.
    out_ += fmt::format(
        "<clipPath id=\"map\"><rect width=\"{:.1f}\" height=\"{:.1f}\"/></clipPath>\n<g "
        "clip-path=\"url(#map)\">\n",
        kMapWidth_px, height_px_);
    draw("keep_out", "fill=\"#d7191c\" fill-opacity=\"0.35\" stroke=\"#67001f\"");
    draw("keep_in", "fill=\"none\" stroke=\"#0050a0\" stroke-width=\"2\" stroke-dasharray=\"10 5\"");
    out_ += "</g>\n";
  }

  // Steps whose slip was measured here, of the sols before the answer's where it has one.
  void draw_measured(const std::vector<steps::SlipStep>& steps, const JsonValue& request) {
    const JsonValue* const as_of_sol = request.find("as_of_sol");
    for (const steps::SlipStep& step : steps) {
      if (!step.x_eqc_m || !step.y_eqc_m || !extent_.contains(*step.x_eqc_m, *step.y_eqc_m)) continue;
      if (as_of_sol && step.sol >= as_of_sol->number) continue;
      measured_ = true;
      out_ += fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\" stroke=\"black\" stroke-width=\"0.5\"/>\n",
          x(*step.x_eqc_m), y(*step.y_eqc_m), kSlipColours[class_of(kSlipColours, step.slip)].colour);
    }
  }

  void draw_route(const DrawnRoute& route) {
    line(route, 0, route.x_m.size() - 1, "white", 7.0, false);
    for (std::size_t begin = 0; begin + 1 < route.x_m.size();) {
      std::size_t end = begin + 1;
      while (end + 1 < route.x_m.size() &&
             class_of(colours_, route.value[end + 1]) == class_of(colours_, route.value[begin + 1]) &&
             route.unknown[end + 1] == route.unknown[begin + 1])
        ++end;
      line(route, begin, end, colours_[class_of(colours_, route.value[begin + 1])].colour, 4.0,
           route.unknown[begin + 1]);
      begin = end;
    }
  }

  // The number stands where the routes are apart.
  void label_route(const DrawnRoute& route, std::size_t place, std::size_t of) {
    const std::size_t at = route.x_m.size() * (place + 1) / (of + 1);
    out_ += fmt::format(
        "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"11\" fill=\"white\" stroke=\"black\"/>{2}\n",
        x(route.x_m[at]), y(route.y_m[at]),
        svg_text(fmt::format("x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" font-weight=\"bold\"",
                             x(route.x_m[at]), y(route.y_m[at]) + 5.0),
                 route.rank));
    mark_worst(route);
  }

  // A ring around the largest slip.
  void mark_worst(const DrawnRoute& route) {
    const auto worst = static_cast<std::size_t>(
        std::max_element(route.slip.begin(), route.slip.end(),
                         [](double a, double b) { return std::abs(a) < std::abs(b); }) -
        route.slip.begin());
    out_ += fmt::format(
        "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"8\" fill=\"none\" stroke=\"black\" stroke-width=\"2\"/>\n",
        x(route.x_m[worst]), y(route.y_m[worst]));
  }

  // Where a check of the slip belongs.
  void mark_checks(const DrawnRoute& route, const std::vector<double>& before_m) {
    for (const double at_m : before_m) {
      const auto k =
          static_cast<std::size_t>(std::lower_bound(route.distance_m.begin(), route.distance_m.end(), at_m) -
                                   route.distance_m.begin());
      if (k >= route.x_m.size()) continue;  // beyond the way on the mean soils
      checks_ = true;
      out_ += fmt::format(
          "<path d=\"M{:.1f} {:.1f}l6 6l-6 6l-6 -6z\" fill=\"white\" stroke=\"black\" stroke-width=\"2\"/>\n",
          x(route.x_m[k]), y(route.y_m[k]) - 6.0);
    }
  }

  void mark_ends(const DrawnRoute& route) {
    mark(route.x_m.front(), route.y_m.front(), "start");
    mark(route.x_m.back(), route.y_m.back(), route.verdict == "no_go" ? "end" : "goal");
  }

  std::string finish(std::string_view title) {
    scale_bar();
    const double legend_height_px = legend(title);
    return fmt::format(
               "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 "
               "{0:.0f} {1:.0f}\" "
               "font-family=\"sans-serif\" font-size=\"14\">\n<rect width=\"100%\" height=\"100%\" "
               "fill=\"white\"/>\n",
               kMapWidth_px + kLegendWidth_px, std::max({height_px_, 420.0, legend_height_px})) +
           out_ + "</svg>\n";
  }

 private:
  struct LegendRow {
    const char* colour;
    std::string words;
    double opacity;
  };

  double x(double x_m) const { return scale_ * (x_m - extent_.west_m); }
  double y(double y_m) const { return scale_ * (extent_.north_m - y_m); }

  void line(const DrawnRoute& route, std::size_t begin, std::size_t end, const char* colour, double width,
            bool dashed) {
    out_ += fmt::format(
        "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"{} points=\"",
        colour, width, dashed ? " stroke-dasharray=\"7 4\"" : "");
    for (std::size_t k = begin; k <= end; ++k)
      out_ += fmt::format("{:.1f},{:.1f} ", x(route.x_m[k]), y(route.y_m[k]));
    out_ += "\"/>\n";
  }

  void mark(double x_m, double y_m, std::string_view words) {
    out_ += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"12\" height=\"12\" fill=\"yellow\" stroke=\"black\"/>{}\n",
        x(x_m) - 6.0, y(y_m) - 6.0,
        svg_text(
            fmt::format("x=\"{:.1f}\" y=\"{:.1f}\" font-weight=\"bold\" stroke=\"white\" stroke-width=\"3\" "
                        "paint-order=\"stroke\"",
                        x(x_m) + 10.0, y(y_m) + 5.0),
            words));
  }

  void scale_bar() {
    const double wide_m = (extent_.east_m - extent_.west_m) / 4.0;
    const double power = std::pow(10.0, std::floor(std::log10(wide_m)));
    const double length_m = power * (wide_m / power >= 5.0 ? 5.0 : wide_m / power >= 2.0 ? 2.0 : 1.0);
    out_ += fmt::format(
        "<rect x=\"12\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"6\" fill=\"black\" stroke=\"white\"/>{}\n",
        height_px_ - 18.0, scale_ * length_m,
        svg_text(
            fmt::format("x=\"12\" y=\"{:.1f}\" stroke=\"white\" stroke-width=\"3\" paint-order=\"stroke\"",
                        height_px_ - 24.0),
            fmt::format("{:g} m, north is up", length_m)));
  }

  // Its height, px.
  double legend(std::string_view title) {
    double at = 24.0;
    const double left = kMapWidth_px + 14.0;
    const auto row = [&](const std::string& sign, std::string_view words) {
      out_ += fmt::format("<g transform=\"translate({:.0f} {:.0f})\">{}{}</g>\n", left, at, sign,
                          svg_text("x=\"36\" y=\"5\"", words));
      at += 24.0;
    };
    for (const std::string& line : in_lines(title)) {
      out_ += svg_text(fmt::format("x=\"{:.0f}\" y=\"{:.0f}\" font-weight=\"bold\"", left, at), line) + "\n";
      at += 18.0;
    }
    at += 8.0;
    for (const ValueColour& c : colours_)
      row(fmt::format("<path d=\"M0 0h28\" stroke=\"{}\" stroke-width=\"5\"/>", c.colour), c.words);
    row("<path d=\"M0 0h28\" stroke=\"black\" stroke-width=\"4\" stroke-dasharray=\"7 4\"/>",
        "on unknown ground");
    row("<circle cx=\"14\" cy=\"0\" r=\"8\" fill=\"none\" stroke=\"black\" stroke-width=\"2\"/>",
        "largest slip of a route");
    if (measured_)
      row("<circle cx=\"14\" cy=\"0\" r=\"3\" fill=\"#1a9850\" stroke=\"black\" stroke-width=\"0.5\"/>",
          "measured slip");
    if (has_keep_out_)
      row("<rect y=\"-8\" width=\"28\" height=\"16\" fill=\"#d7191c\" fill-opacity=\"0.5\"/>", "keep-out");
    if (has_keep_in_)
      row("<path d=\"M0 0h28\" stroke=\"#0050a0\" stroke-width=\"2\" stroke-dasharray=\"10 5\"/>",
          "edge of a keep-in");
    if (checks_)
      row("<path d=\"M14 -8l8 8l-8 8l-8 -8z\" fill=\"white\" stroke=\"black\" stroke-width=\"2\"/>",
          "check the slip before going on");
    for (const LegendRow& l : legend_)
      row(fmt::format("<rect y=\"-8\" width=\"28\" height=\"16\" fill=\"{}\" fill-opacity=\"{}\"/>", l.colour,
                      l.opacity),
          l.words);
    row("<rect y=\"-8\" width=\"28\" height=\"16\" fill=\"#999\"/>", "unknown ground");
    return at;
  }

  const GroundWindow& ground_;
  std::span<const ValueColour> colours_;
  dem::Extent extent_;
  bool checks_ = false, has_keep_out_ = false, has_keep_in_ = false, measured_ = false;
  double scale_ = 1.0, height_px_ = 0.0;
  std::string out_;
  std::vector<LegendRow> legend_;
};

// Wider where it would be tall, so that a map goes on a page with words.
dem::Extent broad(dem::Extent e) {
  constexpr double kMaxHeightToWidth = 0.55;
  const double width_m = std::max(e.east_m - e.west_m, (e.north_m - e.south_m) / kMaxHeightToWidth);
  const double middle_m = 0.5 * (e.west_m + e.east_m);
  return {middle_m - 0.5 * width_m, e.south_m, middle_m + 0.5 * width_m, e.north_m};
}

struct Drawn {
  std::shared_ptr<const TerrainSite> site;
  std::vector<DrawnRoute> routes;
  GroundWindow ground;
};

Result<Drawn> read_drawn(const Catalogue& catalogue, const JsonValue& document, bool is_broad) {
  const auto site = terrain_at(catalogue, json::text(document, "terrain"),
                               json::text(json::at(document, "provenance"), "terrain_version"));
  if (!site) return fail(site.error());
  std::vector<DrawnRoute> routes = routes_of(document);
  if (routes.empty()) return fail(ErrorCode::kNoData, "the answer has no route to draw");
  const dem::Extent extent = extent_of(routes);
  auto ground = (*site)->read(is_broad ? broad(extent) : extent);
  if (ground) ground = thinned_for_picture(*ground);
  if (!ground) return fail(ground.error());
  return Drawn{*site, std::move(routes), *std::move(ground)};
}

// What happens on the stretch that a station lies on, for each station.
std::vector<double> outcomes_along(const std::vector<double>& distance_m, const JsonValue& stretches) {
  std::vector<double> values;
  std::size_t k = 0;
  for (const double at_m : distance_m) {
    while (k + 1 < stretches.elements.size() && at_m > json::number(stretches.elements[k], "to_m") + 1e-6)
      ++k;
    values.push_back(stretches.elements.empty() ? 0.0
                                                : json::number(stretches.elements[k], "expected_stops") +
                                                      json::number(stretches.elements[k], "embedding"));
  }
  return values;
}

}  // namespace

Result<std::string> draw_route_map(const Catalogue& catalogue, std::string_view answer) {
  const auto document = json::parse(answer, {.bytes = answer.size(), .values = answer.size()});
  if (!document) return fail(document.error());
  const auto drawn = read_drawn(catalogue, *document, false);
  if (!drawn) return fail(drawn.error());
  const std::vector<DrawnRoute>& routes = drawn->routes;
  Picture picture(drawn->ground, kSlipColours);
  if (const auto ground = picture.draw_ground(); !ground) return fail(ground.error());
  picture.draw_soils();
  picture.draw_zones(json::at(*document, "request"));
  picture.draw_measured(drawn->site->steps(), json::at(*document, "request"));
  // The best route last, so that it lies on top.
  for (auto route = routes.rbegin(); route != routes.rend(); ++route) picture.draw_route(*route);
  for (std::size_t k = 0; k < routes.size(); ++k) picture.label_route(routes[k], k, routes.size());
  picture.mark_ends(routes.front());
  return picture.finish(drawn->site->description().title);
}

Result<std::string> draw_outcome_map(const Catalogue& catalogue, const JsonValue& check) {
  auto drawn = read_drawn(catalogue, check, true);
  if (!drawn) return fail(drawn.error());
  DrawnRoute& route = drawn->routes.front();
  route.verdict = json::text(check, "verdict");
  const JsonValue& outcomes = json::at(check, "outcomes");
  route.value = outcomes_along(route.distance_m, json::at(outcomes, "stretches"));
  Picture picture(drawn->ground, kOutcomeColours);
  if (const auto ground = picture.draw_ground(); !ground) return fail(ground.error());
  picture.draw_soils();
  picture.draw_zones(json::at(check, "request"));
  picture.draw_measured(drawn->site->steps(), json::at(check, "request"));
  picture.draw_route(route);
  picture.mark_worst(route);
  picture.mark_checks(route, numbers(json::at(outcomes, "recommended"), "slip_checks_before_m"));
  picture.mark_ends(route);
  return picture.finish(drawn->site->description().title);
}

}  // namespace slipway::api
