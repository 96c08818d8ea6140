#include "api/documents/plan_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "api/json/parse.h"
#include "api/json/writer.h"

namespace slipway::api::json {
namespace {

constexpr double kMoved_m = 1.0;   // further apart on average: another line
constexpr double kChanged = 0.05;  // of a figure, as a share
constexpr double kChangedRisk = 0.05;

const JsonValue kNothing;

const JsonValue& at(const JsonValue& value, std::string_view key) {
  const JsonValue* const found = value.find(key);
  return found != nullptr ? *found : kNothing;
}

// A figure of a route, by its key: a number, or an object with the number as its value.
struct Figure {
  const char* key;
  bool is_share;  // compared as it is, and not in proportion
};
constexpr std::array<Figure, 6> kFigures{Figure{"mean_slip", false},     Figure{"max_slip", false},
                                         Figure{"max_sinkage_m", false}, Figure{"max_current_a", false},
                                         Figure{"energy_wh", false},     Figure{"risk", true}};

// Nothing where a plan has null: on ground that is known by a slip curve alone.
std::optional<double> figure(const JsonValue& route, const char* key) {
  const JsonValue& value = at(route, key);
  if (value.is(JsonValue::Kind::kNull)) return std::nullopt;
  return value.is(JsonValue::Kind::kObject) ? at(value, "value").number : value.number;
}

struct Route {
  const JsonValue* figures = nullptr;  // its row of the summary
  std::vector<std::array<double, 2>> line;
};

std::vector<Route> routes_of(const JsonValue& plan) {
  std::vector<Route> routes;
  const std::vector<JsonValue>& features = at(at(plan, "routes"), "features").elements;
  for (const JsonValue& row : at(plan, "summary").elements) {
    Route route{&row, {}};
    if (routes.size() < features.size())
      for (const JsonValue& point : at(at(features[routes.size()], "geometry"), "coordinates").elements)
        route.line.push_back({point.elements[0].number, point.elements[1].number});
    routes.push_back(std::move(route));
  }
  return routes;
}

// Mean over one line's points of the distance to the other's nearest point.
double mean_distance_m(const Route& from, const Route& to) {
  if (from.line.empty() || to.line.empty()) return std::numeric_limits<double>::max();
  double sum = 0.0;
  for (const auto& a : from.line) {
    double nearest = std::numeric_limits<double>::max();
    for (const auto& b : to.line) nearest = std::min(nearest, std::hypot(a[0] - b[0], a[1] - b[1]));
    sum += nearest;
  }
  return sum / static_cast<double>(from.line.size());
}

struct Pair {
  const Route* nominal = nullptr;
  const Route* corrected = nullptr;
  double apart_m = 0.0;
};

// The two that are nearest first, and so on; then those that are left.
std::vector<Pair> pairs_of(const std::vector<Route>& nominal, const std::vector<Route>& corrected) {
  std::vector<Pair> all, pairs;
  for (const Route& a : nominal)
    for (const Route& b : corrected)
      all.push_back({&a, &b, std::max(mean_distance_m(a, b), mean_distance_m(b, a))});
  std::stable_sort(all.begin(), all.end(),
                   [](const Pair& a, const Pair& b) { return a.apart_m < b.apart_m; });
  const auto taken = [&](const Route* route) {
    return std::any_of(pairs.begin(), pairs.end(),
                       [&](const Pair& p) { return p.nominal == route || p.corrected == route; });
  };
  for (const Pair& pair : all)
    if (!taken(pair.nominal) && !taken(pair.corrected)) pairs.push_back(pair);
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.nominal < b.nominal; });
  for (const Route& route : nominal)
    if (!taken(&route)) pairs.push_back({&route, nullptr, 0.0});
  for (const Route& route : corrected)
    if (!taken(&route)) pairs.push_back({nullptr, &route, 0.0});
  return pairs;
}

std::vector<std::string> changes_of(const Pair& pair) {
  if (pair.corrected == nullptr) return {"no longer among the routes"};
  if (pair.nominal == nullptr) return {"a new route"};
  std::vector<std::string> changes;
  const JsonValue &before = *pair.nominal->figures, &after = *pair.corrected->figures;
  if (at(before, "verdict").text != at(after, "verdict").text)
    changes.push_back(
        fmt::format("verdict {}, was {}", at(after, "verdict").text, at(before, "verdict").text));
  if (at(before, "rank").number != at(after, "rank").number)
    changes.push_back(
        fmt::format("rank {:.0f}, was {:.0f}", at(after, "rank").number, at(before, "rank").number));
  if (pair.apart_m > kMoved_m) changes.push_back(fmt::format("moved by {:.1f} m on average", pair.apart_m));
  for (const Figure& f : kFigures) {
    const std::optional<double> old = figure(before, f.key), now = figure(after, f.key);
    if (!old || !now) continue;
    const bool changed = f.is_share ? std::abs(*now - *old) >= kChangedRisk
                                    : std::abs(*now - *old) > kChanged * std::max(std::abs(*old), 1e-9);
    if (changed) changes.push_back(fmt::format("{} {:.3g}, was {:.3g}", f.key, *now, *old));
  }
  return changes;
}

void write_side(Writer& w, std::string_view side, const Route* route) {
  w.key(side);
  if (route == nullptr) {
    w.null();
    return;
  }
  const JsonValue& row = *route->figures;
  w.begin_object()
      .whole("rank", std::lround(at(row, "rank").number))
      .text("verdict", at(row, "verdict").text);
  for (const Figure& f : kFigures) {
    if (const std::optional<double> value = figure(row, f.key))
      w.significant(f.key, *value);
    else
      w.key(f.key).null();
  }
  w.end_object();
}

}  // namespace

Result<std::string> compare_plans(std::string_view nominal, std::string_view corrected) {
  const auto before = parse(nominal, {.bytes = nominal.size(), .values = nominal.size()});
  const auto after = parse(corrected, {.bytes = corrected.size(), .values = corrected.size()});
  for (const auto* const plan : {&before, &after}) {
    if (!*plan) return fail(plan->error());
    if (at(**plan, "format").text != "plan/1") return fail(ErrorCode::kInternal, "the answer is not a plan");
  }
  const std::vector<Route> old_routes = routes_of(*before), new_routes = routes_of(*after);
  Writer w;
  w.begin_object().text("format", "plan-comparison/1").key("routes").begin_array();
  for (const Pair& pair : pairs_of(old_routes, new_routes)) {
    w.begin_object();
    write_side(w, "nominal", pair.nominal);
    write_side(w, "corrected", pair.corrected);
    w.key("apart_m");
    if (pair.nominal != nullptr && pair.corrected != nullptr)
      w.metres(pair.apart_m);
    else
      w.null();
    w.texts("changed", changes_of(pair)).end_object();
  }
  w.end_array().key("nominal").raw(nominal).key("corrected").raw(corrected).end_object();
  return w.take();
}

}  // namespace slipway::api::json
