#include "api/documents/plan_answer.h"

#include "api/documents/check_answer.h"
#include "api/documents/drive_commands.h"
#include "api/documents/drive_routes.h"
#include "api/documents/drive_series.h"
#include "api/documents/drive_so_far.h"
#include "api/documents/dynamic_series.h"
#include "api/documents/plan_request.h"
#include "api/json/parse.h"
#include "api/json/writer.h"

namespace slipway::api::json {
namespace {

// What a route is called, how it is judged and its figures: the row of the summary and the feature's
// properties.
void write_judged_route(Writer& w, const planner::Route& route) {
  w.whole("rank", route.rank).text("planner", route.planner).text("profile", route.profile);
  w.text("verdict", planner::describe(route.verdict())).texts("reasons", route.reasons);
  w.boolean("pareto", route.pareto).significant("cost", route.cost);
  w.key("cost_shares").begin_array();
  for (const planner::CostShare& share : route.shares) {
    w.begin_object().text("name", share.name).significant("value", share.value).text("unit", share.unit);
    w.significant("weight", share.weight).significant("cost", share.cost).end_object();
  }
  w.end_array();
  w.significant("expected_cost", route.expected_cost).significant("cvar_cost", route.cvar_cost);
  write_drive_figures(w, route.prediction);
  write_drive_steps(w, route.commands);
}

}  // namespace

std::string write_plan_answer(const PlanAnswer& answer, StationDetail detail) {
  Writer w;
  w.begin_object().text("format", "plan/1");
  w.text("terrain", answer.request.terrain).text("rover", answer.request.rover);
  write_provenance(w, answer.provenance);
  write_learnt_drive(w, answer.provenance.learnt, answer.request.drive);
  w.key("request").raw(write_plan_request(answer.request));
  w.whole("candidates", answer.plan.candidates).texts("fewer_because", answer.plan.fewer_because);
  w.key("summary").begin_array();
  for (const planner::Route& route : answer.plan.routes) {
    w.begin_object();
    write_judged_route(w, route);
    if (route.dynamic) write_dynamic_figures(w, *route.dynamic);
    w.end_object();
  }
  w.end_array();
  w.key("scout");
  if (const auto& scout = answer.plan.scout) {
    w.begin_object().whole("route", scout->route).significant("worth", scout->worth);
    w.significant("other_route", scout->other_route).end_object();
  } else {
    w.null();
  }
  std::vector<RouteFeature> features;
  for (const planner::Route& route : answer.plan.routes) {
    const std::vector<std::size_t> shown = stations_in(detail, route.prediction, answer.plan.routes.size());
    const auto properties = [&answer, &route, shown](Writer& of) {
      write_judged_route(of, route);
      write_decision(of, route.decision);
      write_outcomes(of, route.prediction, answer.provenance, answer.request.drive.bars);
      write_position_uncertainty(of, route.prediction, answer.request.drive.checks);
      write_stations(of, route.prediction, answer.provenance, shown);
      if (route.dynamic) write_dynamic_drive(of, *route.dynamic);
    };
    features.push_back(
        {.id = route.rank, .prediction = route.prediction, .shown = shown, .properties = properties});
  }
  write_routes(w, features, answer.provenance);
  w.end_object();
  return w.take();
}

Result<std::string> geojson_of(std::string_view answer) {
  // Our own bytes: only the depth is as for anybody's.
  const auto document = parse(answer, {.bytes = answer.size(), .values = answer.size()});
  if (!document) return fail(document.error());
  const JsonValue* routes = document->find("routes");
  if (const JsonValue* const where = document->find("where")) routes = where->find("places");  // a diagnosis
  if (routes == nullptr && document->find("estimates") != nullptr)  // of soils: nothing of it lies on a map
    return std::string(R"({"type":"FeatureCollection","features":[]})");
  if (routes == nullptr) return fail(ErrorCode::kInternal, "the answer holds no GeoJSON");
  Writer w;
  write_value(w, *routes);
  return w.take();
}

}  // namespace slipway::api::json
