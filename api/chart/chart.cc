#include "api/chart/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "api/chart/chart_axes.h"

namespace slipway::api {
namespace {

// Okabe and Ito's palette, whose colours can be distinguished with every common kind of colour blindness.
constexpr std::array kColours{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"};
constexpr double kPanel_px = 420.0, kPlotHeight_px = 270.0;
constexpr double kLeft_px = 66.0, kRight_px = 18.0, kTitle_px = 44.0, kPanelTitle_px = 26.0;
constexpr double kBelow_px = 52.0, kCategory_px = 96.0, kLegendRow_px = 22.0;
constexpr double kFont_px = 13.0, kLetter_px = 0.56 * kFont_px;
constexpr std::size_t kPanelsInARow = 3;

const char* colour_of(std::size_t index) {
  return kColours[index % kColours.size()];
}

std::string open_svg(double width, double height, std::string_view title) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\" font-family=\"sans-serif\" font-size=\"{2:.0f}\" fill=\"#222\">\n<title>{3}</title>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
      "<text x=\"{4:.0f}\" y=\"28\" font-size=\"17\" font-weight=\"bold\">{3}</text>\n",
      width, height, kFont_px, xml_text(title), 14.0);
}

std::string dot(std::size_t colour, double x, double y) {
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\" fill=\"{}\" fill-opacity=\"0.55\"/>", x, y,
                     colour_of(colour));
}

// The sign of one point. Its shape belongs to its colour, so that either one identifies the series.
std::string sign(std::size_t colour, double x, double y) {
  const char* c = colour_of(colour);
  switch (colour % 4) {
    case 0:
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.6\" fill=\"{}\" fill-opacity=\"0.8\"/>",
                         x, y, c);
    case 1:
      return fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"6.6\" height=\"6.6\" fill=\"{}\" fill-opacity=\"0.8\"/>",
          x - 3.3, y - 3.3, c);
    case 2:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l4.2 7.2h-8.4z\" fill=\"{}\" fill-opacity=\"0.8\"/>", x,
                         y - 4.4, c);
    default:
      return fmt::format(
          "<path d=\"M{:.1f} {:.1f}l4.6 4.6l-4.6 4.6l-4.6 -4.6z\" fill=\"{}\" "
          "fill-opacity=\"0.8\"/>",
          x, y - 4.6, c);
  }
}

bool has_line(ChartMark mark) {
  return mark != ChartMark::kPoints && mark != ChartMark::kDots;
}
bool has_points(ChartMark mark) {
  return mark == ChartMark::kPoints || mark == ChartMark::kLineAndPoints;
}

struct LegendEntry {
  std::string name;
  bool band = false;
  ChartMark mark = ChartMark::kLine;
  std::size_t colour = 0;
  bool operator==(const LegendEntry&) const = default;
};

std::string legend_sign(const LegendEntry& entry, double x, double y) {
  if (entry.band)
    return fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"26\" height=\"12\" fill=\"{}\" "
        "fill-opacity=\"0.2\"/>",
        x, y - 6.0, colour_of(entry.colour));
  std::string text;
  if (has_line(entry.mark))
    text += fmt::format("<path d=\"M{:.1f} {:.1f}h26\" stroke=\"{}\" stroke-width=\"2\"{}/>", x, y,
                        colour_of(entry.colour),
                        entry.mark == ChartMark::kDashedLine ? " stroke-dasharray=\"6 4\"" : "");
  if (has_points(entry.mark)) text += sign(entry.colour, x + 13.0, y);
  if (entry.mark == ChartMark::kDots) text += dot(entry.colour, x + 13.0, y);
  return text;
}

// The legend's entries, each once; entries without a name are left out.
void add_entry(std::vector<LegendEntry>& entries, LegendEntry entry) {
  if (!entry.name.empty() && std::find(entries.begin(), entries.end(), entry) == entries.end())
    entries.push_back(std::move(entry));
}

std::vector<LegendEntry> legend_of(std::span<const ChartSeries> series) {
  std::vector<LegendEntry> entries;
  for (const ChartSeries& s : series) add_entry(entries, {s.name, false, s.mark, s.colour});
  return entries;
}

std::vector<LegendEntry> legend_of(std::span<const Chart> charts) {
  std::vector<LegendEntry> entries;
  for (const Chart& chart : charts) {
    for (LegendEntry& entry : legend_of(chart.series)) add_entry(entries, std::move(entry));
    for (const ChartBand& b : chart.bands) add_entry(entries, {b.name, true, ChartMark::kLine, b.colour});
  }
  return entries;
}

// Frame, grid, ticks and titles of one plot.
void draw_axes(std::string& out, const ChartAxis& x_axis, const ChartAxis& y_axis, const AxisScale& x,
               const AxisScale& y, double left, double top, double width, double height) {
  for (const AxisScale::Tick& tick : x.ticks()) {
    out += fmt::format("<path d=\"M{:.1f} {:.1f}v{:.1f}\" stroke=\"#e3e3e3\"/>\n", tick.at_px, top, height);
    const std::string words = xml_text(tick.words);
    if (x_axis.categories.empty())
      out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", tick.at_px,
                         top + height + 17.0, words);
    else
      out += fmt::format(
          "<text transform=\"translate({:.1f} {:.1f}) rotate(-35)\" text-anchor=\"end\" "
          "font-size=\"11\">{}</text>\n",
          tick.at_px + 4.0, top + height + 14.0, words);
  }
  for (const AxisScale::Tick& tick : y.ticks())
    out += fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}h{2:.1f}\" stroke=\"#e3e3e3\"/><text x=\"{3:.1f}\" y=\"{4:.1f}\" "
        "text-anchor=\"end\">{5}</text>\n",
        left, tick.at_px, width, left - 6.0, tick.at_px + 4.5, xml_text(tick.words));
  out += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" stroke=\"#888\"/>\n",
      left, top, width, height);
  out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", left + width / 2.0,
                     top + height + (x_axis.categories.empty() ? 38.0 : kCategory_px - 8.0),
                     xml_text(x_axis.title));
  out += fmt::format(
      "<text transform=\"translate({:.1f} {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
      left - 48.0, top + height / 2.0, xml_text(y_axis.title));
}

void draw_line(std::string& out, const ChartSeries& s, const AxisScale& x, const AxisScale& y) {
  std::string path;
  bool down = false;
  for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i) {
    const bool shown = x.shows(s.x[i]) && y.shows(s.y[i]);
    if (shown) path += fmt::format("{}{:.1f} {:.1f}", down ? "L" : "M", x.px(s.x[i]), y.px(s.y[i]));
    down = shown;
  }
  if (path.empty()) return;
  out += fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-linejoin=\"round\"{}/>\n", path,
      colour_of(s.colour), s.mark == ChartMark::kDashedLine ? " stroke-dasharray=\"6 4\"" : "");
}

// Draws whole signs, also of points on the frame, and no points beyond it. Dots, of which there may be
// thousands, are one path.
void draw_points(std::string& out, const ChartSeries& s, const AxisScale& x, const AxisScale& y) {
  if (has_line(s.mark) && !has_points(s.mark)) return;
  std::string dots;
  for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i) {
    if (!x.contains(s.x[i]) || !y.contains(s.y[i])) continue;
    if (s.mark == ChartMark::kDots)
      dots += fmt::format("M{:.1f} {:.1f}h0", x.px(s.x[i]), y.px(s.y[i]));
    else
      out += sign(s.colour, x.px(s.x[i]), y.px(s.y[i])) + "\n";
  }
  if (!dots.empty())
    out += fmt::format(
        "<path d=\"{}\" stroke=\"{}\" stroke-width=\"4\" stroke-linecap=\"round\" "
        "stroke-opacity=\"0.6\"/>\n",
        dots, colour_of(s.colour));
}

// Draws series over the cells of a heat map; the lines do not leave its frame.
void draw_series(std::string& out, std::span<const ChartSeries> series, const AxisScale& x,
                 const AxisScale& y) {
  if (series.empty()) return;
  const double left = x.px(x.lowest()), right = x.px(x.highest());
  const double top = y.px(y.highest()), bottom = y.px(y.lowest());
  out += fmt::format(
      "<clipPath id=\"cells\"><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>"
      "</clipPath>\n<g clip-path=\"url(#cells)\">\n",
      left, top, right - left, bottom - top);
  for (const ChartSeries& s : series)
    if (has_line(s.mark)) draw_line(out, s, x, y);
  out += "</g>\n";
  for (const ChartSeries& s : series) draw_points(out, s, x, y);
}

void draw_band(std::string& out, const ChartBand& b, const AxisScale& x, const AxisScale& y) {
  std::string there, back;
  for (std::size_t i = 0; i < std::min({b.x.size(), b.lower.size(), b.upper.size()}); ++i) {
    if (!x.shows(b.x[i]) || !y.shows(b.lower[i]) || !y.shows(b.upper[i])) continue;
    there += fmt::format("{}{:.1f} {:.1f}", there.empty() ? "M" : "L", x.px(b.x[i]), y.px(b.upper[i]));
    back.insert(0, fmt::format("L{:.1f} {:.1f}", x.px(b.x[i]), y.px(b.lower[i])));
  }
  if (!there.empty())
    out += fmt::format("<path d=\"{}{}Z\" fill=\"{}\" fill-opacity=\"0.2\"/>\n", there, back,
                       colour_of(b.colour));
}

void draw_panel(std::string& out, const Chart& chart, std::size_t index, double left, double top) {
  std::vector<double> xs, ys;
  for (const ChartSeries& s : chart.series) {
    xs.insert(xs.end(), s.x.begin(), s.x.end());
    ys.insert(ys.end(), s.y.begin(), s.y.end());
  }
  for (const ChartBand& b : chart.bands) {
    xs.insert(xs.end(), b.x.begin(), b.x.end());
    ys.insert(ys.end(), b.lower.begin(), b.lower.end());
    ys.insert(ys.end(), b.upper.begin(), b.upper.end());
  }
  const double width = kPanel_px - kLeft_px - kRight_px;
  left += kLeft_px;
  out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-weight=\"bold\">{}</text>\n", left, top + 17.0,
                     xml_text(chart.title));
  top += kPanelTitle_px;
  const AxisScale x(chart.x, xs, left, left + width), y(chart.y, ys, top + kPlotHeight_px, top);
  draw_axes(out, chart.x, chart.y, x, y, left, top, width, kPlotHeight_px);
  out += fmt::format(
      "<clipPath id=\"panel{0}\"><rect x=\"{1:.1f}\" y=\"{2:.1f}\" width=\"{3:.1f}\" height=\"{4:.1f}\"/>"
      "</clipPath>\n<g clip-path=\"url(#panel{0})\">\n",
      index, left, top, width, kPlotHeight_px);
  for (const ChartBand& b : chart.bands) draw_band(out, b, x, y);
  if (chart.diagonal) {
    const double from = std::max(x.lowest(), y.lowest()), to = std::min(x.highest(), y.highest());
    out +=
        fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#888\" stroke-dasharray=\"3 3\"/>\n",
                    x.px(from), y.px(from), x.px(to), y.px(to));
  }
  for (const ChartSeries& s : chart.series)
    if (has_line(s.mark)) draw_line(out, s, x, y);
  out += "</g>\n";
  for (const ChartSeries& s : chart.series) draw_points(out, s, x, y);
}

// Lays the entries out in rows that fit the width; returns the legend's height.
double draw_legend(std::string& out, const std::vector<LegendEntry>& entries, double width, double top) {
  double x = kLeft_px, y = top + kLegendRow_px / 2.0;
  for (const LegendEntry& entry : entries) {
    const double needed = 34.0 + kLetter_px * static_cast<double>(entry.name.size()) + 22.0;
    if (x > kLeft_px && x + needed > width) {
      x = kLeft_px;
      y += kLegendRow_px;
    }
    out += legend_sign(entry, x, y) + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x + 34.0,
                                                  y + 4.5, xml_text(entry.name));
    x += needed;
  }
  return entries.empty() ? 0.0 : y - top + kLegendRow_px;
}

// Dark blue over green to yellow, even in lightness [van der Walt and Smith, viridis].
std::string heat_colour(double share) {
  constexpr std::array<std::array<double, 3>, 6> kStops{
      {{68, 1, 84}, {65, 68, 135}, {42, 120, 142}, {34, 168, 132}, {122, 209, 81}, {253, 231, 37}}};
  const double at = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1.0);
  const auto k = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const double t = at - static_cast<double>(k);
  std::array<int, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c)
    rgb[c] = static_cast<int>(std::lround((1.0 - t) * kStops[k][c] + t * kStops[k + 1][c]));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

void draw_colour_bar(std::string& out, const AxisScale& scale, const std::string& title, double left,
                     double top, double height) {
  constexpr int kSteps = 64;
  for (int k = 0; k < kSteps; ++k)
    out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"16\" height=\"{:.2f}\" fill=\"{}\"/>\n", left,
                       top + height * (kSteps - 1 - k) / kSteps, height / kSteps + 0.4,
                       heat_colour((k + 0.5) / kSteps));
  out += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"16\" height=\"{:.1f}\" fill=\"none\" "
      "stroke=\"#888\"/>\n",
      left, top, height);
  for (const AxisScale::Tick& tick : scale.ticks())
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left + 22.0, tick.at_px + 4.5,
                       xml_text(tick.words));
  out += fmt::format(
      "<text transform=\"translate({:.1f} {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
      left + 72.0, top + height / 2.0, xml_text(title));
}

}  // namespace

std::string xml_text(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return escaped;
}

std::string svg_text(std::string_view attributes, std::string_view words) {
  return fmt::format("<text {}>{}</text>", attributes, xml_text(words));
}

std::string draw_charts(std::string_view title, std::span<const Chart> charts) {
  const std::size_t across =
      std::clamp<std::size_t>(charts.size() == 4 ? 2 : charts.size(), 1, kPanelsInARow);
  const std::size_t down = (charts.size() + across - 1) / across;
  bool categories = false;
  for (const Chart& chart : charts) categories = categories || !chart.x.categories.empty();
  const double panel_height = kPanelTitle_px + kPlotHeight_px + (categories ? kCategory_px : kBelow_px);
  const double letters = 28.0 + 0.6 * 17.0 * static_cast<double>(title.size());
  const double width = std::max(kPanel_px * static_cast<double>(across), letters);
  const double legend_top = kTitle_px + panel_height * static_cast<double>(down);
  std::string panels, legend;
  for (std::size_t k = 0; k < charts.size(); ++k) {
    const std::size_t row = k / across, column = k % across;
    draw_panel(panels, charts[k], k, kPanel_px * static_cast<double>(column),
               kTitle_px + panel_height * static_cast<double>(row));
  }
  const double legend_height = draw_legend(legend, legend_of(charts), width, legend_top);
  return open_svg(width, legend_top + legend_height + 6.0, title) + panels + legend + "</svg>\n";
}

std::string draw_heat_map(const HeatMap& map) {
  const double left = kLeft_px, top = kTitle_px + 6.0, side = 400.0;
  const double width =
      std::max(left + side + 110.0, 28.0 + 0.6 * 17.0 * static_cast<double>(map.title.size()));
  ChartAxis x_axis = map.x, y_axis = map.y;
  if (map.x_edges.empty() || map.y_edges.empty()) return open_svg(width, 60.0, map.title) + "</svg>\n";
  if (!x_axis.lowest) x_axis.lowest = map.x_edges.front();
  if (!x_axis.highest) x_axis.highest = map.x_edges.back();
  if (!y_axis.lowest) y_axis.lowest = map.y_edges.front();
  if (!y_axis.highest) y_axis.highest = map.y_edges.back();
  const AxisScale x(x_axis, {}, left, left + side), y(y_axis, {}, top + side, top);
  std::vector<double> values;
  for (const auto& value : map.values)
    if (value) values.push_back(*value);
  const ChartAxis value_axis{map.value_title, {}, {}, false, {}};
  const AxisScale scale(value_axis, values, top + side, top);
  std::string legend;
  const std::vector<LegendEntry> entries = legend_of(map.series);
  const double legend_height = draw_legend(legend, entries, width, top + side + kBelow_px);
  std::string out = open_svg(width, top + side + kBelow_px + legend_height, map.title);
  const std::size_t columns = map.x_edges.size() - 1, rows = map.y_edges.size() - 1;
  for (std::size_t k = 0; k < std::min(map.values.size(), rows * columns); ++k) {
    const double x0 = x.px(map.x_edges[k % columns]), x1 = x.px(map.x_edges[k % columns + 1]);
    const double y0 = y.px(map.y_edges[k / columns + 1]), y1 = y.px(map.y_edges[k / columns]);
    const double value = map.values[k].value_or(0.0);
    out += fmt::format(
        "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\" "
        "shape-rendering=\"crispEdges\"/>\n",
        x0, y0, x1 - x0, y1 - y0,
        map.values[k] && std::isfinite(value)
            ? heat_colour((value - scale.lowest()) / (scale.highest() - scale.lowest()))
            : "#bbb");
  }
  draw_axes(out, x_axis, y_axis, x, y, left, top, side, side);
  draw_series(out, map.series, x, y);
  draw_colour_bar(out, scale, map.value_title, left + side + 20.0, top, side);
  return out + legend + "</svg>\n";
}

}  // namespace slipway::api
