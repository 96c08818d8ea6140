#include "api/report/sweep_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "api/json/parse.h"

namespace slipway::api {
namespace {

using json::JsonValue;

struct UnitSuffix {
  std::string_view unit, suffix;
};
constexpr std::array kUnitSuffixes{UnitSuffix{"deg", "_deg"}, UnitSuffix{"N", "_n"},
                                   UnitSuffix{"m", "_m"},     UnitSuffix{"Pa", "_pa"},
                                   UnitSuffix{"m/s", "_m_s"}, UnitSuffix{"m/s^2", "_m_s2"},
                                   UnitSuffix{"degC", "_c"},  UnitSuffix{"kg/m^3", "_kg_m3"}};

struct Parameter {
  std::string words;  // "slip angle"
  std::string unit;   // "deg", "" where it has none
};

Parameter words_of(std::string_view name) {
  const auto field = sim::sweep_field(name);
  Parameter parameter{std::string(name), field && field->unit != "1" ? std::string(field->unit) : ""};
  for (const std::string_view prefix : {"soil.", "wheel.", "effects."}) {
    if (parameter.words.starts_with(prefix)) parameter.words.erase(0, prefix.size());
  }
  for (const auto& [unit, suffix] : kUnitSuffixes) {
    if (parameter.unit == unit && parameter.words.ends_with(suffix))
      parameter.words.resize(parameter.words.size() - suffix.size());
  }
  // k_c, k_phi and k_s are symbols.
  if (!parameter.words.starts_with("k_")) {
    for (char& c : parameter.words) c = c == '_' || c == '.' ? ' ' : c;
  }
  return parameter;
}

// Values in equal ratios, and many of them.
bool is_logarithmic(const std::vector<double>& values) {
  constexpr std::size_t kFew = 5;
  if (values.size() < kFew || values.front() <= 0.0) return false;
  const double first = values[1] / values[0], last = values.back() / values[values.size() - 2];
  return first > 1.0 && std::abs(last - first) < 1e-6 * first;
}

ChartAxis axis_of(const sim::SweepAxis& axis) {
  ChartAxis chart_axis;
  chart_axis.title = parameter_title(axis.parameter);
  if (is_logarithmic(axis.values)) {
    chart_axis.logarithmic = true;
    chart_axis.lowest = axis.values.front();
    chart_axis.highest = axis.values.back();
  }
  return chart_axis;
}

// Halfway between the values, and as far beyond the ends.
std::vector<double> edges_of(std::vector<double> values) {
  if (values.size() == 1) return {values[0] - 0.5, values[0] + 0.5};
  std::vector<double> edges{1.5 * values[0] - 0.5 * values[1]};
  for (std::size_t i = 1; i < values.size(); ++i) edges.push_back(0.5 * (values[i - 1] + values[i]));
  edges.push_back(1.5 * values.back() - 0.5 * values[values.size() - 2]);
  return edges;
}

std::string draw_as_heat_map(std::string_view title, std::span<const sim::SweepAxis> axes,
                             const SweptQuantity& quantity) {
  HeatMap map;
  map.title = title;
  map.x.title = parameter_title(axes[0].parameter);
  map.y.title = parameter_title(axes[1].parameter);
  // Cells in rising order, whatever the order of the values.
  const auto order = [](const std::vector<double>& values) {
    std::vector<std::size_t> by(values.size());
    for (std::size_t i = 0; i < by.size(); ++i) by[i] = i;
    std::sort(by.begin(), by.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    return by;
  };
  const auto sorted = [](std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return edges_of(std::move(values));
  };
  map.x_edges = sorted(axes[0].values);
  map.y_edges = sorted(axes[1].values);
  map.value_title = quantity.title;
  for (const std::size_t y : order(axes[1].values)) {
    for (const std::size_t x : order(axes[0].values))
      map.values.push_back(quantity.values[x * axes[1].values.size() + y]);
  }
  return draw_heat_map(map);
}

struct Panel {
  std::string_view key, title;
  double scale;
};
constexpr Panel kSlip{"slip", "slip", 1.0};  // of a wheel, or a rover, on a slope
constexpr std::array kPanels{Panel{"drawbar_pull_n", "drawbar pull, N", 1.0},
                             Panel{"lateral_force_n", "lateral force, N", 1.0},
                             Panel{"sinkage_m", "sinkage, mm", 1e3},
                             Panel{"torque_nm", "torque, N m", 1.0},
                             Panel{"current_a", "motor current, A", 1.0},
                             Panel{"tractive_efficiency", "tractive efficiency", 1.0}};

std::vector<SweptQuantity> quantities_of(const JsonValue& rows, bool on_slopes) {
  std::vector<SweptQuantity> quantities;
  std::vector<Panel> panels(kPanels.begin(), kPanels.end());
  if (on_slopes) panels.insert(panels.begin(), kSlip);
  for (const Panel& panel : panels) {
    SweptQuantity quantity{std::string(panel.title), {}};
    bool any = false;
    for (const JsonValue& row : rows.elements) {
      const JsonValue* const cell = row.find(panel.key);
      quantity.values.push_back(cell ? std::optional(panel.scale * cell->number) : std::nullopt);
      any = any || (cell != nullptr && cell->number != 0.0);
    }
    if (any) quantities.push_back(std::move(quantity));
  }
  return quantities;
}

}  // namespace

std::string parameter_title(std::string_view parameter) {
  const Parameter p = words_of(parameter);
  return p.unit.empty() ? p.words : fmt::format("{}, {}", p.words, p.unit);
}

Chart sweep_chart(std::string_view title, std::span<const sim::SweepAxis> axes,
                  const SweptQuantity& quantity) {
  Chart chart;
  chart.title = title;
  chart.x = axis_of(axes[0]);
  chart.y.title = quantity.title;
  const std::size_t lines = axes.size() > 1 ? axes[1].values.size() : 1;
  constexpr std::size_t kFewPoints = 25;
  for (std::size_t k = 0; k < lines; ++k) {
    ChartSeries series;
    series.colour = k;
    series.mark = axes[0].values.size() <= kFewPoints ? ChartMark::kLineAndPoints : ChartMark::kLine;
    if (axes.size() > 1) {
      const Parameter p = words_of(axes[1].parameter);
      series.name =
          fmt::format("{} {:.6g}{}{}", p.words, axes[1].values[k], p.unit.empty() ? "" : " ", p.unit);
    }
    for (std::size_t i = 0; i < axes[0].values.size(); ++i) {
      series.x.push_back(axes[0].values[i]);
      series.y.push_back(quantity.values[i * lines + k].value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

std::string draw_sweep(std::string_view title, std::span<const sim::SweepAxis> axes,
                       std::span<const SweptQuantity> quantities) {
  if (axes.size() > 1 && axes[1].values.size() > kMaxSweepLines)
    return draw_as_heat_map(title, axes, quantities.front());
  std::vector<Chart> charts;
  for (const SweptQuantity& quantity : quantities) charts.push_back(sweep_chart("", axes, quantity));
  return draw_charts(title, charts);
}

Result<std::string> draw_wheel_sweep(std::string_view document) {
  const auto parsed = json::parse(document, {.bytes = document.size(), .values = document.size()});
  if (!parsed) return fail(parsed.error());
  const JsonValue* const request = parsed->find("request");
  const JsonValue* const rows = parsed->find("rows");
  if (request == nullptr || rows == nullptr)
    return fail(ErrorCode::kInternal, "the answer has no request or no rows");
  std::vector<sim::SweepAxis> axes;
  for (const JsonValue& axis : request->find("sweep")->elements) {
    axes.push_back({axis.find("parameter")->text, {}});
    for (const JsonValue& value : axis.find("values")->elements) axes.back().values.push_back(value.number);
  }
  if (axes.empty() || request->find("paired") != nullptr)
    return fail(ErrorCode::kInvalidRequest, "there is nothing to draw",
                {{"/sweep", "a picture needs a sweep; rows with their own parameters are none"}});
  const bool on_slopes = request->find("slope_deg") != nullptr ||
                         std::any_of(axes.begin(), axes.end(),
                                     [](const sim::SweepAxis& a) { return a.parameter == "slope_deg"; });
  const std::vector<SweptQuantity> quantities = quantities_of(*rows, on_slopes);
  if (quantities.empty())
    return fail(ErrorCode::kInvalidRequest, "there is nothing to draw",
                {{"/sweep", "the wheel is sunk to its axle in every row"}});
  const bool load_is_swept =
      std::any_of(axes.begin(), axes.end(), [](const sim::SweepAxis& a) { return a.parameter == "load_n"; });
  const JsonValue* const load_n = request->find("load_n");
  const std::string load = load_n && !load_is_swept ? fmt::format(", {:.4g} N", load_n->number) : "";
  return draw_sweep(
      fmt::format("{} {} on {}{}", request->find("whole_rover") != nullptr ? "The whole of" : "One wheel of",
                  request->find("rover")->text, request->find("soil")->text, load),
      axes, quantities);
}

}  // namespace slipway::api
