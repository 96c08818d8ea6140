#include "api/documents/plan_request.h"

#include <utility>
#include <vector>

#include "api/documents/drive_assumptions.h"
#include "api/documents/zones.h"
#include "api/json/parse.h"

namespace slipway::api::json {
namespace {

void read_weights(ObjectReader& reader, planner::Weights& weights) {
  auto object = reader.object("weights", kOptional);
  if (!object) return;
  for (std::size_t row = 0; row < weights.terms().size(); ++row) {
    const Field& field = weights.terms()[row].weight;
    object->number(field.name, kOptional, {field.unit, field.lowest, field.highest}, weights[row]);
  }
  object->refuse_unknown();
}

void read_start_error(ObjectReader& reader, std::optional<planner::StartError>& out) {
  auto object = reader.object("start_error", kOptional);
  if (!object) return;
  planner::StartError& error = out.emplace();
  object->number("position_m", kOptional, {"m", 0.0, RequestLimits::kStartError_m}, error.position_m);
  object->angle_deg("heading_deg", kOptional, {"deg", 0.0, RequestLimits::kStartError_deg},
                    error.heading_rad);
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
  // A drive under way goes on from where it is.
  const Presence needs_start = document->find("drive_so_far") != nullptr ? kOptional : kRequired;
  bool has_start = false;
  for (const auto& [key, target] : {std::pair{"start", &request.start}, std::pair{"goal", &request.goal}}) {
    const bool is_start = target == &request.start;
    const JsonValue* const value = reader.member(key, is_start ? needs_start : kRequired);
    if (is_start) has_start = value != nullptr;
    if (value != nullptr) read_waypoint(*value, child_pointer("", key), *target, reading.faults);
  }
  read_start_error(reader, request.start_error);
  for (const Element& element : reader.list("waypoints", kOptional, {0, RequestLimits::kWaypoints})) {
    read_waypoint(*element.value, element.pointer, request.waypoints.emplace_back(), reading.faults);
  }
  read_zones(reader, request.keep_out, request.keep_in, reading.faults);
  read_weights(reader, request.weights);
  read_ranking(reader, request.ranking);
  reader.whole("routes", kOptional, 1, RequestLimits::kRoutes, request.routes);
  reader.whole("verify", kOptional, 0, planner::kMaxVerified, request.verify);
  reader.texts("planners", kOptional, {0, 20}, {.most = 64}, request.planners);
  read_drive_assumptions(reader, request.drive);
  if (!has_start) request.start = place_reached(request.drive).value_or(request.start);
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
  if (request.start_error)
    w.key("start_error")
        .begin_object()
        .exact("position_m", request.start_error->position_m)
        .angle_deg("heading_deg", request.start_error->heading_rad)
        .end_object();
  w.key("waypoints").begin_array();
  for (const planner::Waypoint& waypoint : request.waypoints) write_waypoint(w, waypoint);
  w.end_array();
  write_zones(w, request.keep_out, request.keep_in);
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
