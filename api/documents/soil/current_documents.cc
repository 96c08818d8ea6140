#include "api/documents/soil/current_documents.h"

#include "api/documents/drive_assumptions.h"
#include "api/files/effect_settings.h"
#include "api/json/writer.h"
#include "core/angle.h"

namespace slipway::api::json {
namespace {

void write_panel(Writer& w, const CurrentPanel& panel) {
  w.begin_object().text("name", panel.name).text("title", panel.title).text("soil", panel.soil);
  w.key("axes").begin_array();
  for (const sim::SweepAxis& axis : panel.axes) {
    const auto field = sim::sweep_field(axis.parameter);
    w.begin_object().text("parameter", axis.parameter).text("unit", field ? field->unit : "").key("values");
    w.begin_array();
    for (const double value : axis.values) w.exact(value);
    w.end_array().end_object();
  }
  w.end_array().key("points").begin_array();
  for (const sim::CurrentPoint& point : panel.points) {
    w.begin_object();
    for (std::size_t a = 0; a < panel.axes.size(); ++a) w.exact(panel.axes[a].parameter, point.place.at[a]);
    if (point.current_a) {
      w.significant("current_a", *point.current_a).significant("sinkage_m", point.sinkage_m);
      w.significant("torque_nm", point.torque_nm);
    } else {
      w.text("reason", point.reason);
    }
    w.end_object();
  }
  w.end_array().end_object();
}

void write_request(Writer& w, const CurrentInversionRequest& request) {
  w.key("request").begin_object().text("rover", request.rover).text("wheel", request.wheel);
  w.text("soil", request.soil).exact("current_a", request.current_a);
  if (request.load_n) w.exact("load_n", *request.load_n);
  w.exact("gravity_m_s2", request.gravity_m_s2);
  if (request.speed_m_s) w.exact("speed_m_s", *request.speed_m_s);
  if (request.motor_temp_c) w.exact("motor_temp_c", *request.motor_temp_c);
  write_effects(w, request.effects);
  w.exact("max_slip", request.options.max_slip).exact("accepted_risk", request.options.accepted_risk);
  w.whole("draws", request.options.draws).whole("seed", static_cast<std::int64_t>(request.options.seed));
  w.end_object();
}

void write_quantiles(Writer& w, const sim::SlipQuantiles& q) {
  w.key("soil_draws").begin_object().whole("draws", q.draws).whole("with_a_slip", q.solved);
  w.whole("current_above", q.above).whole("current_below", q.below);
  if (q.solved > 0)
    w.significant("slip_p05", q.p05).significant("slip_p50", q.p50).significant("slip_p95", q.p95);
  w.significant("risk", q.risk).end_object();
}

void write_degrees(Writer& w, std::string_view name, const std::optional<double>& rad) {
  if (rad) w.significant(name, deg_from_rad(*rad));
}

}  // namespace

std::string write_current_maps(const CurrentMaps& maps) {
  Writer w;
  w.begin_object().text("format", "current_map/1").text("title", maps.title);
  if (maps.figure != 0) w.whole("figure", maps.figure);
  w.text("model", api::describe(maps.options.model)).text("rover", maps.options.rover);
  if (maps.options.load_n) w.exact("load_n", *maps.options.load_n);
  w.exact("gravity_m_s2", maps.options.gravity_m_s2).exact("slip", maps.options.slip);
  w.key("panels").begin_array();
  for (const CurrentPanel& panel : maps.panels) write_panel(w, panel);
  w.end_array().end_object();
  return w.take();
}

std::string write_current_inversion(const CurrentInversion& inversion) {
  const sim::CurrentInverse& answer = inversion.answer;
  Writer w;
  w.begin_object().text("format", "current_inverse/1");
  write_request(w, inversion.request);
  w.text("verdict", sim::describe(answer.verdict)).texts("reasons", answer.words);
  if (answer.found.reported) w.significant("slip", *answer.found.reported);
  w.key("slips").begin_array();
  for (const double slip : answer.found.slips) w.significant(slip);
  w.end_array();
  if (answer.found.stands)
    w.significant("least_current_a", answer.found.least_current_a)
        .significant("greatest_current_a", answer.found.greatest_current_a);
  if (answer.wheel)
    w.significant("drawbar_pull_n", answer.wheel->forces.drawbar_pull_n)
        .significant("torque_nm", answer.wheel->forces.torque_nm)
        .significant("sinkage_m", answer.wheel->sinkage_m);
  if (answer.greatest)
    w.significant("greatest_pull_n", answer.greatest->pull_n)
        .significant("greatest_pull_slip", answer.greatest->slip);
  if (answer.share_of_pull) w.significant("share_of_pull", *answer.share_of_pull);
  write_degrees(w, "slope_in_use_deg", answer.slope_in_use_rad);
  write_degrees(w, "slope_greatest_deg", answer.slope_greatest_rad);
  write_degrees(w, "slope_left_deg", answer.slope_left_rad);
  write_quantiles(w, answer.quantiles);
  w.end_object();
  return w.take();
}

}  // namespace slipway::api::json
