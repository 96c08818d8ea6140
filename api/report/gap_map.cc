#include "api/report/gap_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "api/chart/base64.h"
#include "api/chart/chart.h"
#include "api/report/value_palette.h"
#include "dem/write/hillshade.h"

namespace slipway::api {
namespace {

using gap::WindowGap;

constexpr std::size_t kMaxTerrains = 6;
constexpr double kMap_px = 392.0, kMapHeight_px = 300.0, kGap_px = 14.0;
constexpr double kLeft_px = 14.0, kTitle_px = 44.0, kRowTitle_px = 24.0, kLegend_px = 66.0;
constexpr int kHillshadeColumns = 98, kHillshadeRows = 75;  // of the hillshade
constexpr double kMargin = 1.12, kMin_m = 2.0;
constexpr double kExaggeration = 1.5, kDarkest = 120.0, kBrightest = 250.0;

struct Level {
  double below;
  const char* colour;
  const char* words;
};
constexpr std::array kLevels{
    Level{1.25, kValuePalette[0], "as the noise (below 1.25)"}, Level{1.75, kValuePalette[1], "1.25 to 1.75"},
    Level{2.5, kValuePalette[2], "1.75 to 2.5"}, Level{4.0, kValuePalette[3], "2.5 to 4"},
    Level{1e300, kValuePalette[4], "above 4 deviations"}};

struct LadderStep {
  const char* words;
  double WindowGap::*value;
};
constexpr std::array kLadder{LadderStep{"nominal", &WindowGap::nominal},
                             LadderStep{"re-tuned", &WindowGap::retuned},
                             LadderStep{"with effects", &WindowGap::with_effects}};

std::size_t level_of(double deviations) {
  std::size_t k = 0;
  while (k + 1 < kLevels.size() && !(deviations < kLevels[k].below)) ++k;
  return k;
}

// Where a map lies: one scale both ways, all windows and the discs among them within.
struct Frame {
  double west_m = 1e300, east_m = -1e300, south_m = 1e300, north_m = -1e300, px_per_m = 1.0;

  void hold(double x_m, double y_m, double around_m = 0.0) {
    west_m = std::min(west_m, x_m - around_m);
    east_m = std::max(east_m, x_m + around_m);
    south_m = std::min(south_m, y_m - around_m);
    north_m = std::max(north_m, y_m + around_m);
  }
  void close() {
    const double width = kMargin * std::max(kMin_m, east_m - west_m),
                 height = kMargin * std::max(kMin_m, north_m - south_m);
    px_per_m = std::min(kMap_px / width, kMapHeight_px / height);
    const double x_m = 0.5 * (west_m + east_m), y_m = 0.5 * (south_m + north_m);
    west_m = x_m - 0.5 * kMap_px / px_per_m;
    north_m = y_m + 0.5 * kMapHeight_px / px_per_m;
  }
  double x(double x_m) const { return px_per_m * (x_m - west_m); }
  double y(double y_m) const { return px_per_m * (north_m - y_m); }
};

// The ground under a frame, lit from the north-west; white off the map. Nothing where no PNG can be made.
std::string hillshade_in(const sim::Ground& ground, const Frame& frame) {
  const Eigen::Vector3d sun = Eigen::Vector3d(-1.0, 1.0, 1.2).normalized();
  std::vector<std::uint8_t> grey;
  for (int row = 0; row < kHillshadeRows; ++row)
    for (int column = 0; column < kHillshadeColumns; ++column) {
      const auto point =
          ground.at(frame.west_m + (column + 0.5) * kMap_px / kHillshadeColumns / frame.px_per_m,
                    frame.north_m - (row + 0.5) * kMapHeight_px / kHillshadeRows / frame.px_per_m);
      double light = kBrightest + 5.0;
      if (point) {
        Eigen::Vector3d normal = point->normal;
        normal.head<2>() *= kExaggeration;
        light = kDarkest + (kBrightest - kDarkest) * std::max(0.0, normal.normalized().dot(sun));
      }
      grey.push_back(static_cast<std::uint8_t>(std::lround(light)));
    }
  const auto png = dem::encode_png(grey, kHillshadeRows, kHillshadeColumns);
  if (!png) return {};
  return fmt::format(
      "<image width=\"{:.0f}\" height=\"{:.0f}\" preserveAspectRatio=\"none\" "
      "href=\"data:image/png;base64,{}\"/>\n",
      kMap_px, kMapHeight_px, base64(*png));
}

// Beside the largest differences the rest is faint: they are drawn last.
std::string windows_in(const std::vector<const WindowGap*>& windows, const Frame& frame,
                       const LadderStep& step) {
  std::array<std::string, kLevels.size()> paths;
  for (const WindowGap* window : windows) {
    const double value = window->*step.value;
    if (!std::isfinite(value) || window->stations.empty()) continue;
    std::string& path = paths[level_of(value)];
    const Pose2& first = window->stations.front();
    path += fmt::format("M{:.1f} {:.1f}", frame.x(first.x_m), frame.y(first.y_m));
    for (std::size_t k = 1; k < window->stations.size(); ++k)
      path +=
          fmt::format("L{:.1f} {:.1f}", frame.x(window->stations[k].x_m), frame.y(window->stations[k].y_m));
    if (window->stations.size() == 1) path += "h0";
  }
  std::string out;
  for (std::size_t k = 0; k < paths.size(); ++k)
    if (!paths[k].empty())
      out += fmt::format(
          "<path d=\"{0}\" fill=\"none\" stroke=\"white\" stroke-width=\"6\" stroke-linecap=\"round\"/>\n"
          "<path d=\"{0}\" fill=\"none\" stroke=\"{1}\" stroke-width=\"4\" stroke-linecap=\"round\"/>\n",
          paths[k], kLevels[k].colour);
  return out;
}

std::string scale_bar(const Frame& frame) {
  const double wide_m = kMap_px / frame.px_per_m / 4.0;
  const double power = std::pow(10.0, std::floor(std::log10(wide_m)));
  const double length_m = power * (wide_m / power >= 5.0 ? 5.0 : wide_m / power >= 2.0 ? 2.0 : 1.0);
  return fmt::format(
      "<rect x=\"8\" y=\"{0:.1f}\" width=\"{1:.1f}\" height=\"5\" fill=\"black\" stroke=\"white\"/>"
      "<text x=\"8\" y=\"{2:.1f}\" stroke=\"white\" stroke-width=\"3\" paint-order=\"stroke\">{3:g} m, north "
      "is up</text>\n",
      kMapHeight_px - 14.0, frame.px_per_m * length_m, kMapHeight_px - 20.0, length_m);
}

std::string legend(double top, bool places) {
  std::string out;
  double x = kLeft_px;
  for (const Level& level : kLevels) {
    out += fmt::format(
        "<path d=\"M{0:.0f} {1:.0f}h24\" stroke=\"{2}\" stroke-width=\"5\" stroke-linecap=\"round\"/>"
        "<text x=\"{3:.0f}\" y=\"{4:.0f}\">{5}</text>\n",
        x + 3.0, top, level.colour, x + 36.0, top + 4.5, level.words);
    x += 64.0 + 7.6 * static_cast<double>(std::string_view(level.words).size());
  }
  const double left = kLeft_px + (places ? 36.0 : 3.0);
  if (places)
    out += fmt::format(
        "<circle cx=\"{:.0f}\" cy=\"{:.0f}\" r=\"9\" fill=\"none\" stroke=\"black\" stroke-width=\"2\" "
        "stroke-dasharray=\"5 3\"/>\n",
        kLeft_px + 15.0, top + 26.0);
  return out +
         fmt::format(
             "<text x=\"{:.0f}\" y=\"{:.0f}\">{}lines are windows of drives, the worst drawn last; root "
             "mean square over channels, in deviations of their noise</text>\n",
             left, top + 30.5, places ? "a place where the gap sits; " : "");
}

// Indices of the terrains to show, in the campaign's order: of many, those whose windows are furthest off.
std::vector<std::size_t> shown_terrains(const std::vector<std::vector<const WindowGap*>>& windows) {
  std::vector<std::size_t> shown;
  std::vector<double> worst(windows.size(), 0.0);
  for (std::size_t t = 0; t < windows.size(); ++t) {
    for (const WindowGap* window : windows[t])
      worst[t] += window->nominal * window->nominal / static_cast<double>(windows[t].size());
    if (!windows[t].empty()) shown.push_back(t);
  }
  if (shown.size() > kMaxTerrains) {
    std::stable_sort(shown.begin(), shown.end(),
                     [&](std::size_t a, std::size_t b) { return worst[a] > worst[b]; });
    shown.resize(kMaxTerrains);
    std::sort(shown.begin(), shown.end());
  }
  return shown;
}

}  // namespace

std::string draw_gap_map(const gap::DriveCampaign& campaign, const gap::Diagnosis& d) {
  std::vector<std::vector<const WindowGap*>> windows(campaign.terrains.size());
  for (const WindowGap& window : d.window_gaps) windows.at(window.terrain).push_back(&window);
  const std::vector<std::size_t> shown = shown_terrains(windows);
  if (shown.empty()) return {};
  const std::size_t steps = d.effects.empty() ? 2 : kLadder.size();
  const double row_px = kRowTitle_px + kMapHeight_px + kGap_px;
  const double width = 2.0 * kLeft_px + 3.0 * kMap_px + 2.0 * kGap_px,
               legend_top = kTitle_px + row_px * static_cast<double>(shown.size()) + 12.0;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#222\">\n<title>{2}</title>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
      "<text x=\"{3:.0f}\" y=\"28\" font-size=\"17\" font-weight=\"bold\">{2}</text>\n"
      "<clipPath id=\"map\"><rect width=\"{4:.0f}\" height=\"{5:.0f}\"/></clipPath>\n",
      width, legend_top + kLegend_px - 22.0, xml_text(fmt::format("{}: the map of the gap", d.campaign)),
      kLeft_px, kMap_px, kMapHeight_px);
  double top = kTitle_px;
  for (const std::size_t t : shown) {
    const gap::CampaignTerrain& terrain = campaign.terrains[t];
    Frame frame;
    for (const WindowGap* window : windows[t])
      for (const Pose2& pose : window->stations) frame.hold(pose.x_m, pose.y_m);
    std::string places;
    for (const gap::GapPlace& place : d.places)
      if (place.terrain == terrain.name) frame.hold(place.x_m, place.y_m, place.radius_m);
    frame.close();
    for (const gap::GapPlace& place : d.places)
      if (place.terrain == terrain.name)
        places += fmt::format(
            "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"none\" stroke=\"black\" "
            "stroke-width=\"2\" stroke-dasharray=\"5 3\"/>\n",
            frame.x(place.x_m), frame.y(place.y_m), frame.px_per_m * place.radius_m);
    const std::string ground = terrain.ground ? hillshade_in(*terrain.ground, frame) : std::string();
    for (std::size_t k = 0; k < steps; ++k) {
      const double left = kLeft_px + (kMap_px + kGap_px) * static_cast<double>(k);
      out += fmt::format(
          "<text x=\"{:.0f}\" y=\"{:.0f}\" font-weight=\"bold\">{}</text>\n<g transform=\"translate({:.0f} "
          "{:.0f})\"><g clip-path=\"url(#map)\">\n",
          left, top + 16.0, xml_text(fmt::format("{}, {}", terrain.name, kLadder[k].words)), left,
          top + kRowTitle_px);
      out.append(ground).append(windows_in(windows[t], frame, kLadder[k])).append(places);
      out += scale_bar(frame);
      out += fmt::format("</g><rect width=\"{:.0f}\" height=\"{:.0f}\" fill=\"none\" stroke=\"#888\"/></g>\n",
                         kMap_px, kMapHeight_px);
    }
    top += row_px;
  }
  return out + legend(legend_top, !d.places.empty()) + "</svg>\n";
}

}  // namespace slipway::api
