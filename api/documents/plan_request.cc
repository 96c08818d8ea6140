#include "api/documents/plan_request.h"

#include <cmath>
#include <utility>
#include <vector>

#include "api/documents/drive_assumptions.h"
#include "api/json/parse.h"

namespace slipway::api::json {
namespace {

// Twice the signed area of the ring [shoelace formula].
double doubled_area(const planner::Polygon& ring) {
  double sum = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d& a = ring[i];
    const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
    // Relative to the first corner: map coordinates are large and areas small.
    sum += (a.x() - ring[0].x()) * (b.y() - ring[0].y()) - (b.x() - ring[0].x()) * (a.y() - ring[0].y());
  }
  return sum;
}

bool read_corner(const Element& element, Eigen::Vector2d& out, std::vector<Fault>& faults) {
  if (!element.value->is(JsonValue::Kind::kArray) || element.value->elements.size() != 2) {
    faults.push_back({element.pointer, "is " + describe(*element.value) + ", must be [x_m, y_m]"});
    return false;
  }
  const NumberRule rule{"m", -1e8, 1e8};
  const bool x =
      read_number(element.value->elements[0], element.pointer + "/0", "x_m", rule, out.x(), faults);
  const bool y =
      read_number(element.value->elements[1], element.pointer + "/1", "y_m", rule, out.y(), faults);
  return x && y;
}

void read_ring(const Element& element, planner::Polygon& ring, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  const JsonValue& value = *element.value;
  const std::size_t count = value.elements.size();
  if (!value.is(JsonValue::Kind::kArray) || count < 3 || count > RequestLimits::kKeepOutCorners) {
    faults.push_back({element.pointer, "is " + describe(value) + ", must be a list of 3 to " +
                                           std::to_string(RequestLimits::kKeepOutCorners) +
                                           " corners [x_m, y_m]"});
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector2d corner = Eigen::Vector2d::Zero();
    read_corner({&value.elements[i], child_pointer(element.pointer, i)}, corner, faults);
    ring.push_back(corner);
  }
  if (faults.size() != before) return;
  if (ring.front() == ring.back()) ring.pop_back();  // a ring closed as GeoJSON closes it
  constexpr double kMinArea_m2 = 1e-4;
  if (ring.size() < 3 || std::abs(doubled_area(ring)) < 2.0 * kMinArea_m2) {
    faults.push_back({element.pointer, "encloses no area"});
  }
}

void read_weights(ObjectReader& reader, planner::Weights& weights) {
  auto object = reader.object("weights", kOptional);
  if (!object) return;
  for (std::size_t row = 0; row < weights.terms().size(); ++row) {
    const Field& field = weights.terms()[row].weight;
    object->number(field.name, kOptional, {field.unit, field.lowest, field.highest}, weights[row]);
  }
  object->refuse_unknown();
}

constexpr planner::RankBy kRankBy[] = {planner::RankBy::kExpected, planner::RankBy::kCvar};

void read_ranking(ObjectReader& reader, planner::Ranking& ranking) {
  auto object = reader.object("ranking", kOptional);
  if (!object) return;
  std::size_t by = 0;
  if (object->choice("by", kOptional, {planner::describe(kRankBy[0]), planner::describe(kRankBy[1])}, by))
    ranking.by = kRankBy[by];
  object->number("tail", kOptional, {.unit = "1", .lowest = 0.0, .highest = 1.0, .above_lowest = true},
                 ranking.tail);
  object->refuse_unknown();
}

}  // namespace

Result<Reading<PlanRequest>> read_plan_request(std::string_view bytes,
                                               std::span<const planner::CostTerm> costs) {
  const auto document = parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  Reading<PlanRequest> reading;
  PlanRequest& request = reading.request;
  request.weights = planner::Weights(costs);
  ObjectReader reader(*document, "", reading.faults);
  if (!reader.is_object()) return reading;
  read_names(reader, request.terrain, request.rover);
  for (const auto& [key, target] : {std::pair{"start", &request.start}, std::pair{"goal", &request.goal}}) {
    const JsonValue* const value = reader.member(key, kRequired);
    if (value != nullptr) read_waypoint(*value, child_pointer("", key), *target, reading.faults);
  }
  for (const Element& element : reader.list("waypoints", kOptional, {0, RequestLimits::kWaypoints})) {
    read_waypoint(*element.value, element.pointer, request.waypoints.emplace_back(), reading.faults);
  }
  for (const Element& element : reader.list("keep_out", kOptional, {0, RequestLimits::kKeepOuts})) {
    read_ring(element, request.keep_out.emplace_back(), reading.faults);
  }
  read_weights(reader, request.weights);
  read_ranking(reader, request.ranking);
  reader.whole("routes", kOptional, 1, RequestLimits::kRoutes, request.routes);
  reader.whole("verify", kOptional, 0, planner::kMaxVerified, request.verify);
  reader.texts("planners", kOptional, {0, 20}, {.most = 64}, request.planners);
  read_drive_assumptions(reader, request.drive);
  reader.refuse_unknown();
  return reading;
}

std::string write_plan_request(const PlanRequest& request) {
  Writer w;
  w.begin_object();
  w.text("terrain", request.terrain).text("rover", request.rover);
  w.key("start");
  write_waypoint(w, request.start);
  w.key("goal");
  write_waypoint(w, request.goal);
  w.key("waypoints").begin_array();
  for (const planner::Waypoint& waypoint : request.waypoints) write_waypoint(w, waypoint);
  w.end_array();
  w.key("keep_out").begin_array();
  for (const planner::Polygon& ring : request.keep_out) {
    w.begin_array();
    for (const Eigen::Vector2d& corner : ring)
      w.begin_array().exact(corner.x()).exact(corner.y()).end_array();
    w.end_array();
  }
  w.end_array();
  w.key("weights").begin_object();
  for (std::size_t row = 0; row < request.weights.terms().size(); ++row)
    w.exact(request.weights.terms()[row].weight.name, request.weights[row]);
  w.end_object();
  w.key("ranking").begin_object().text("by", planner::describe(request.ranking.by));
  w.exact("tail", request.ranking.tail).end_object();
  w.whole("routes", request.routes).whole("verify", request.verify);
  w.texts("planners", request.planners);
  write_drive_assumptions(w, request.drive);
  w.end_object();
  return w.take();
}

}  // namespace slipway::api::json
