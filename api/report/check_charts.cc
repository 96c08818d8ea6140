#include "api/report/check_charts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "api/json/lookup.h"

namespace slipway::api {
namespace {

using json::at;
using json::JsonValue;
using json::number;
using json::numbers;

constexpr std::size_t kBlue = 0, kRed = 1, kGreen = 2, kBlack = 6;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

Chart chart_of(std::string title, std::string y_title) {
  Chart chart;
  chart.title = std::move(title);
  chart.x.title = "way, m";
  chart.y.title = std::move(y_title);
  return chart;
}

ChartSeries line(std::string name, std::vector<double> x, std::vector<double> y, std::size_t colour,
                 ChartMark mark = ChartMark::kLine) {
  return {.name = std::move(name), .mark = mark, .x = std::move(x), .y = std::move(y), .colour = colour};
}

// From the first place to the last.
ChartSeries limit(const std::vector<double>& x, double value) {
  if (x.empty()) return {};
  return line("limit", {x.front(), x.back()}, {value, value}, kRed, ChartMark::kDashedLine);
}

// A figure that is not known breaks the line.
std::vector<double> known(const JsonValue& stations, std::string_view key) {
  std::vector<double> values;
  for (const JsonValue& value : at(stations, key).elements)
    values.push_back(value.is(JsonValue::Kind::kNumber) ? value.number : kUnknown);
  return values;
}

// The largest over the wheels, station by station.
std::vector<double> largest(const JsonValue& stations, std::string_view key, std::size_t count) {
  std::vector<double> values(count, kUnknown);
  for (const JsonValue& wheel : at(stations, "wheels").elements) {
    const std::vector<double> of_wheel = known(wheel, key);
    for (std::size_t k = 0; k < std::min(count, of_wheel.size()); ++k)
      values[k] = std::isnan(values[k]) ? std::abs(of_wheel[k]) : std::max(values[k], std::abs(of_wheel[k]));
  }
  return values;
}

std::vector<Chart> charts_along(const JsonValue& stations, const JsonValue& limits) {
  const std::vector<double> x = numbers(stations, "distance_m");
  Chart slip = chart_of("Slip", "slip");
  slip.bands.push_back(
      {"5 to 95 % of the draws", x, numbers(stations, "slip_p05"), numbers(stations, "slip_p95"), kBlue});
  slip.series = {line("median of the draws", x, numbers(stations, "slip_p50"), kBlue),
                 line("mean soils", x, numbers(stations, "slip"), kGreen),
                 limit(x, number(limits, "max_slip"))};
  Chart sinkage = chart_of("Sinkage of the deepest wheel", "sinkage, m");
  sinkage.series = {
      line("95 % of the draws", x, known(stations, "sinkage_m_p95"), kBlue, ChartMark::kDashedLine),
      line("mean soils", x, largest(stations, "sinkage_m", x.size()), kGreen),
      limit(x, number(limits, "max_sinkage_m"))};
  Chart current = chart_of("Current of the hottest motor", "current, A");
  current.series = {
      line("95 % of the draws", x, known(stations, "current_a_p95"), kBlue, ChartMark::kDashedLine),
      line("mean soils", x, largest(stations, "current_a", x.size()), kGreen),
      limit(x, number(limits, "max_current_a"))};
  Chart tilt = chart_of("Tilt", "tilt, deg");
  tilt.series = {line("mean soils", x, numbers(stations, "tilt_deg"), kGreen),
                 limit(x, number(limits, "max_tilt_deg"))};
  return {slip, sinkage, current, tilt};
}

// A value of each stretch as a step line.
ChartSeries steps(std::string name, const JsonValue& stretches, std::string_view key, std::size_t colour,
                  ChartMark mark = ChartMark::kLine) {
  ChartSeries series = line(std::move(name), {}, {}, colour, mark);
  for (const JsonValue& stretch : stretches.elements) {
    for (const char* const end : {"from_m", "to_m"}) {
      series.x.push_back(number(stretch, end));
      series.y.push_back(number(stretch, key));
    }
  }
  return series;
}

std::vector<Chart> charts_by_stretch(const JsonValue& check) {
  const JsonValue& stretches = at(at(check, "outcomes"), "stretches");
  Chart outcomes = chart_of("Where it stops or is embedded", "per stretch");
  outcomes.y.lowest = 0.0;
  outcomes.series = {
      steps("expected stops", stretches, "expected_stops", kBlue),
      steps("probability of embedding", stretches, "embedding", kBlack, ChartMark::kDashedLine)};
  Chart position = chart_of("Behind the commanded way without looking", "shortfall, m");
  std::vector<double> x{0.0}, low{0.0}, middle{0.0}, high{0.0};
  for (const JsonValue& stretch : at(at(check, "position_uncertainty"), "stretches").elements) {
    const JsonValue& behind = at(stretch, "shortfall_m");
    x.push_back(number(stretch, "to_m"));
    low.push_back(number(behind, "p05"));
    middle.push_back(number(behind, "p50"));
    high.push_back(number(behind, "p95"));
  }
  position.bands.push_back({"5 to 95 % of the draws", x, low, high, kBlue});
  position.series = {line("median of the draws", x, middle, kBlue)};
  return {outcomes, position};
}

}  // namespace

NamedChart draw_check(const JsonValue& check) {
  const JsonValue& limits = at(at(check, "request"), "limits");
  std::vector<Chart> charts;
  for (const JsonValue& feature : at(at(check, "routes"), "features").elements)
    charts = charts_along(at(at(feature, "properties"), "stations"), limits);
  for (Chart& chart : charts_by_stretch(check)) charts.push_back(std::move(chart));
  return {"along", draw_charts("Along the way", charts)};
}

}  // namespace slipway::api
