#include "api/documents/plan_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "api/documents/route_pairs.h"
#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/json/writer.h"

namespace slipway::api::json {
namespace {

constexpr double kMoved_m = 1.0;   // further apart on average: another line
constexpr double kChanged = 0.05;  // of a figure, as a share
constexpr double kChangedRisk = 0.05;

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

std::vector<std::string> changes_of(const RoutePair& pair) {
  if (pair.b == nullptr) return {"no longer among the routes"};
  if (pair.a == nullptr) return {"a new route"};
  std::vector<std::string> changes;
  const JsonValue &before = *pair.a->figures, &after = *pair.b->figures;
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

void write_side(Writer& w, std::string_view side, const AnsweredRoute* route) {
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
  const std::vector<AnsweredRoute> old_routes = routes_of(*before), new_routes = routes_of(*after);
  Writer w;
  w.begin_object().text("format", "plan-comparison/1").key("routes").begin_array();
  for (const RoutePair& pair : pairs_of(old_routes, new_routes)) {
    w.begin_object();
    write_side(w, "nominal", pair.a);
    write_side(w, "corrected", pair.b);
    w.key("apart_m");
    if (pair.a != nullptr && pair.b != nullptr)
      w.metres(pair.apart_m);
    else
      w.null();
    w.texts("changed", changes_of(pair)).end_object();
  }
  w.end_array().key("nominal").raw(nominal).key("corrected").raw(corrected).end_object();
  return w.take();
}

}  // namespace slipway::api::json
