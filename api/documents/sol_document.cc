#include "api/documents/sol_document.h"

#include "api/documents/check_answer.h"
#include "api/documents/plan_answer.h"
#include "api/json/writer.h"
#include "planner/problem/verdict.h"

namespace slipway::api::json {
namespace {

void write_place(Writer& w, const PlaceOnWay& place) {
  w.begin_object().metres("at_m", place.at_m).metres("x_m", place.x_m).metres("y_m", place.y_m);
  w.text("why", place.why).end_object();
}

void write_place(Writer& w, std::string_view key, const std::optional<PlaceOnWay>& place) {
  w.key(key);
  if (place)
    write_place(w, *place);
  else
    w.null();
}

}  // namespace

std::string write_sol(const SolAnswer& answer) {
  const std::vector<planner::Route>& routes = answer.plan.plan.routes;
  const planner::Verdict verdict = routes.empty() ? planner::Verdict::kNoGo : routes.front().verdict();
  Writer w;
  w.begin_object().text("format", "sol/1");
  w.text("terrain", answer.plan.request.terrain).text("rover", answer.plan.request.rover);
  w.text("verdict", planner::describe(verdict));
  w.texts("reasons", routes.empty() ? answer.plan.plan.fewer_because : routes.front().decision.reasons);
  w.key("checks").begin_array();
  for (const PlaceOnWay& check : answer.checks) write_place(w, check);
  w.end_array();
  write_place(w, "time_runs_out", answer.time_runs_out);
  write_place(w, "worst", answer.worst);
  w.key("back_out");
  if (answer.back_out)
    w.raw(write_check_answer(*answer.back_out));
  else
    w.null();
  if (!answer.no_way_back.empty()) w.text("no_way_back", answer.no_way_back);
  w.key("plan").raw(write_plan_answer(answer.plan));
  w.end_object();
  return w.take();
}

}  // namespace slipway::api::json
