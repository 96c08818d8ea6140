#include "api/export/answer_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <variant>

#include "api/chart/vector_styles.h"
#include "api/export/station_csv.h"
#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "core/csv_cells.h"

namespace slipway::api::json {
namespace {

using dem::VectorFeature;
using dem::VectorField;
using dem::VectorLayer;
using dem::VectorValue;

// The place of a field, which is added where the layer has none of this name.
std::size_t field_of(VectorLayer& layer, std::string_view name, bool is_text) {
  for (std::size_t i = 0; i < layer.fields.size(); ++i)
    if (layer.fields[i].name == name) return i;
  layer.fields.push_back({std::string(name), is_text});
  return layer.fields.size() - 1;
}

void set(VectorLayer& layer, VectorFeature& feature, std::string_view name, VectorValue value) {
  const std::size_t place = field_of(layer, name, std::holds_alternative<std::string>(value));
  feature.values.resize(std::max(feature.values.size(), layer.fields.size()));
  if (layer.fields[place].is_text == std::holds_alternative<std::string>(value))
    feature.values[place] = std::move(value);
}

// Members that are one number, text or truth; "value" of an object that has one.
void set_scalars(VectorLayer& layer, VectorFeature& feature, const JsonValue& object) {
  for (std::size_t i = 0; i < object.keys.size(); ++i) {
    const std::string& name = object.keys[i];
    const JsonValue& member = object.elements[i];
    const JsonValue* const inner = member.is(JsonValue::Kind::kObject) ? member.find("value") : nullptr;
    const JsonValue& value = inner != nullptr ? *inner : member;
    if (value.is(JsonValue::Kind::kNumber)) set(layer, feature, name, value.number);
    if (value.is(JsonValue::Kind::kString)) set(layer, feature, name, value.text);
    if (value.is(JsonValue::Kind::kBoolean)) set(layer, feature, name, value.boolean ? 1.0 : 0.0);
  }
}

// The verdict on a route: its own, of a plan's summary, or that of the whole answer.
std::string verdict_of(const JsonValue& document, const JsonValue& feature) {
  const JsonValue& own = at(at(feature, "properties"), "decision");
  if (has(own, "verdict")) return text(own, "verdict");
  if (has(document, "verdict")) return text(document, "verdict");
  return text(at(document, "decision"), "verdict");
}

VectorLayer route_layer(const JsonValue& document) {
  VectorLayer layer{.name = "routes", .lines = true, .fields = {}, .features = {}};
  for (const JsonValue& feature : at(at(document, "routes"), "features").elements) {
    VectorFeature& made = layer.features.emplace_back();
    for (const JsonValue& point : at(at(feature, "geometry"), "coordinates").elements)
      made.points.push_back({point.elements.at(0).number, point.elements.at(1).number,
                             point.elements.size() > 2 ? point.elements[2].number : 0.0});
    set(layer, made, "route", number(feature, "id"));
    set(layer, made, "verdict", verdict_of(document, feature));
    set(layer, made, "rover", text(document, "rover"));
    set(layer, made, "terrain", text(document, "terrain"));
    set_scalars(layer, made, at(feature, "properties"));
  }
  for (VectorFeature& made : layer.features) made.values.resize(layer.fields.size());
  return layer;
}

VectorFeature station_feature(const std::vector<VectorField>& fields, std::string_view line) {
  const auto cells = csv_cells(line);
  VectorFeature made{.points = {{0.0, 0.0, 0.0}}, .values = std::vector<VectorValue>(fields.size())};
  for (std::size_t k = 0; k < fields.size() && k < cells.size(); ++k) {
    const auto number = csv_number(cells[k]);
    if (fields[k].is_text && !cells[k].empty()) made.values[k] = std::string(cells[k]);
    if (!fields[k].is_text && number) made.values[k] = *number;
    if (number && fields[k].name == "x_m") made.points[0][0] = *number;
    if (number && fields[k].name == "y_m") made.points[0][1] = *number;
    if (number && fields[k].name == "height_m") made.points[0][2] = *number;
  }
  return made;
}

// From the table of stations, whose columns have their units in their names: those of a few rows at a time.
class StationRows {
 public:
  StationRows(std::vector<VectorField> fields, std::string page, TablePages pages)
      : fields_(std::move(fields)), page_(std::move(page)), pages_(std::move(pages)) {
    at_ = std::min(page_.find('\n'), page_.size() - 1) + 1;
  }

  Result<std::vector<VectorFeature>> next() {
    constexpr std::size_t kRows = 500;
    std::vector<VectorFeature> some;
    while (some.size() < kRows) {
      if (at_ >= page_.size()) {
        auto page = pages_();
        if (!page) return fail(page.error());
        if (!*page) break;
        page_ = **std::move(page);
        at_ = 0;
      }
      const std::size_t end = std::min(page_.find('\n', at_), page_.size());
      const std::string_view line = std::string_view(page_).substr(at_, end - at_);
      if (!line.empty()) some.push_back(station_feature(fields_, line));
      at_ = end + 1;
    }
    return some;
  }

 private:
  std::vector<VectorField> fields_;
  std::string page_;
  TablePages pages_;
  std::size_t at_ = 0;  // of page_
};

Result<VectorLayer> station_layer(TablePages pages) {
  VectorLayer layer{.name = "stations", .lines = false, .fields = {}, .features = {}};
  auto first = pages();
  if (!first) return fail(first.error());
  if (!*first || (*first)->empty()) return fail(ErrorCode::kNoData, "The table of stations is empty.");
  for (const std::string_view name : csv_cells(csv_lines(**first).front().text))
    layer.fields.push_back({std::string(name), name == "soil" || name == "on_unknown_ground"});
  const auto rows = std::make_shared<StationRows>(layer.fields, **std::move(first), std::move(pages));
  layer.more = [rows] { return rows->next(); };
  return layer;
}

// Places along a route by the distance driven, linear between its stations.
class AlongRoute {
 public:
  explicit AlongRoute(const JsonValue& stations) {
    const JsonValue &distance = at(stations, "distance_m"), &x = at(stations, "x_m"),
                    &y = at(stations, "y_m"), &height = at(stations, "height_m");
    for (std::size_t i = 0; i < distance.elements.size(); ++i) {
      distances_.push_back(distance.elements[i].number);
      points_.push_back({x.elements.at(i).number, y.elements.at(i).number, height.elements.at(i).number});
    }
  }

  double length_m() const { return distances_.empty() ? 0.0 : distances_.back(); }
  std::array<double, 3> at_m(double distance_m) const {
    const auto after = std::lower_bound(distances_.begin(), distances_.end(), distance_m);
    if (after == distances_.begin()) return points_.front();
    if (after == distances_.end()) return points_.back();
    const auto i = static_cast<std::size_t>(after - distances_.begin());
    const double step = distances_[i] - distances_[i - 1];
    const double t = step > 0.0 ? (distance_m - distances_[i - 1]) / step : 0.0;
    std::array<double, 3> place{};
    for (std::size_t k = 0; k < 3; ++k)
      place[k] = points_[i - 1][k] + t * (points_[i][k] - points_[i - 1][k]);
    return place;
  }
  std::vector<std::array<double, 3>> between(double from_m, double to_m) const {
    std::vector<std::array<double, 3>> line{at_m(from_m)};
    for (std::size_t i = 0; i < distances_.size(); ++i)
      if (distances_[i] > from_m && distances_[i] < to_m) line.push_back(points_[i]);
    line.push_back(at_m(std::max(to_m, from_m)));
    return line;
  }

 private:
  std::vector<double> distances_;
  std::vector<std::array<double, 3>> points_;
};

// Each rule, on the stretch where it trips.
VectorLayer rule_layer(const JsonValue& rules, const AlongRoute& along) {
  VectorLayer layer{.name = "rules", .lines = true, .fields = {}, .features = {}};
  for (const JsonValue& rule : rules.elements) {
    VectorFeature& made = layer.features.emplace_back();
    if (has(rule, "from_m") && at(rule, "from_m").is(JsonValue::Kind::kNumber))
      made.points = along.between(number(rule, "from_m"), number(rule, "to_m"));
    set_scalars(layer, made, rule);
    const JsonValue& value = at(rule, "value");
    for (const char* const quantile : {"p05", "p50", "p95"})
      if (has(value, quantile)) set(layer, made, fmt::format("value_{}", quantile), number(value, quantile));
    const JsonValue& trips = at(rule, "trips");
    set(layer, made, "trips_low", number(trips, "low"));
    set(layer, made, "trips_high", number(trips, "high"));
  }
  for (VectorFeature& made : layer.features) made.values.resize(layer.fields.size());
  return layer;
}

// Where the slip is checked on the way, and where a check is recommended.
VectorLayer check_layer(const JsonValue& document, const AlongRoute& along) {
  VectorLayer layer{.name = "checks", .lines = false, .fields = {}, .features = {}};
  const auto add = [&](double distance_m, const char* why) {
    VectorFeature& made = layer.features.emplace_back();
    made.points.push_back(along.at_m(distance_m));
    set(layer, made, "distance_m", distance_m);
    set(layer, made, "why", std::string(why));
  };
  const JsonValue& checks = at(at(document, "request"), "checks");
  const double every_m = has(checks, "slip_check_every_m") ? number(checks, "slip_check_every_m") : 0.0;
  constexpr double kMostChecks = 100'000.0;
  if (every_m > 0.0 && along.length_m() / every_m < kMostChecks)
    for (int i = 1; i * every_m <= along.length_m(); ++i) add(i * every_m, "interval");
  const JsonValue& recommended = at(at(document, "outcomes"), "recommended");
  if (has(recommended, "slip_checks_before_m"))
    for (const JsonValue& place : at(recommended, "slip_checks_before_m").elements)
      add(place.number, "recommended");
  return layer;
}

}  // namespace

TablePages in_one_page(std::string table) {
  return [table = std::move(table), taken = false]() mutable -> Result<std::optional<std::string>> {
    if (std::exchange(taken, true)) return std::nullopt;
    return std::move(table);
  };
}

Result<std::vector<VectorLayer>> answer_layers(std::string_view answer, TablePages stations) {
  if (!stations) {
    auto csv = station_csv(answer);
    if (!csv) return fail(csv.error());
    stations = in_one_page(*std::move(csv));
  }
  auto of_stations = station_layer(std::move(stations));
  if (!of_stations) return fail(of_stations.error());
  const auto document = parse(answer, {.bytes = answer.size(), .values = answer.size()});
  if (!document) return fail(document.error());
  std::vector<VectorLayer> layers{route_layer(*document), *std::move(of_stations)};
  layers[0].style_qml = route_style();
  layers[1].style_qml = station_style();
  const auto& routes = at(at(*document, "routes"), "features").elements;
  if (!has(*document, "outcomes") || routes.empty()) return layers;
  const AlongRoute along(at(at(routes.front(), "properties"), "stations"));
  if (along.length_m() <= 0.0) return layers;
  layers.push_back(rule_layer(at(at(*document, "outcomes"), "rules"), along));
  layers.back().style_qml = rule_style();
  layers.push_back(check_layer(*document, along));
  return layers;
}

}  // namespace slipway::api::json
