#include "api/documents/route_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/json/lookup.h"

namespace slipway::api::json {
namespace {

// Mean over one line's points of the distance to the other's nearest point.
double mean_distance_m(const AnsweredRoute& from, const AnsweredRoute& to) {
  if (from.line.empty() || to.line.empty()) return std::numeric_limits<double>::max();
  double sum = 0.0;
  for (const auto& a : from.line) {
    double nearest = std::numeric_limits<double>::max();
    for (const auto& b : to.line) nearest = std::min(nearest, std::hypot(a[0] - b[0], a[1] - b[1]));
    sum += nearest;
  }
  return sum / static_cast<double>(from.line.size());
}

}  // namespace

std::vector<AnsweredRoute> routes_of(const JsonValue& document) {
  std::vector<AnsweredRoute> routes;
  const std::vector<JsonValue>& features = at(at(document, "routes"), "features").elements;
  const JsonValue& summary = at(document, "summary");
  const bool is_plan = summary.is(JsonValue::Kind::kArray);
  for (std::size_t k = 0; k < (is_plan ? summary.elements.size() : 1); ++k) {
    AnsweredRoute route{is_plan ? &summary.elements[k] : &summary, nullptr, {}};
    if (k < features.size()) {
      route.properties = &at(features[k], "properties");
      for (const JsonValue& point : at(at(features[k], "geometry"), "coordinates").elements)
        route.line.push_back({point.elements[0].number, point.elements[1].number});
    }
    routes.push_back(std::move(route));
  }
  return routes;
}

double apart_m(const AnsweredRoute& a, const AnsweredRoute& b) {
  return std::max(mean_distance_m(a, b), mean_distance_m(b, a));
}

std::vector<RoutePair> pairs_of(const std::vector<AnsweredRoute>& a, const std::vector<AnsweredRoute>& b) {
  std::vector<RoutePair> all, pairs;
  for (const AnsweredRoute& one : a)
    for (const AnsweredRoute& other : b) all.push_back({&one, &other, apart_m(one, other)});
  std::stable_sort(all.begin(), all.end(),
                   [](const RoutePair& p, const RoutePair& q) { return p.apart_m < q.apart_m; });
  const auto taken = [&](const AnsweredRoute* route) {
    return std::any_of(pairs.begin(), pairs.end(),
                       [&](const RoutePair& p) { return p.a == route || p.b == route; });
  };
  for (const RoutePair& pair : all)
    if (!taken(pair.a) && !taken(pair.b)) pairs.push_back(pair);
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const RoutePair& p, const RoutePair& q) { return p.a < q.a; });
  for (const AnsweredRoute& route : a)
    if (!taken(&route)) pairs.push_back({&route, nullptr, 0.0});
  for (const AnsweredRoute& route : b)
    if (!taken(&route)) pairs.push_back({nullptr, &route, 0.0});
  return pairs;
}

}  // namespace slipway::api::json
