#include "api/documents/soil/soil_estimate_document.h"

#include "api/files/soil_file.h"
#include "api/json/writer.h"
#include "core/version.h"

namespace slipway::api::json {
namespace {

using gap::EstimatedParameter;

void write_parameter(Writer& w, const EstimatedParameter& p) {
  const auto boundary = [&](std::string_view key, double value) {
    w.significant(key, p.parameter.boundary_unit() * value);
  };
  const auto range = [&](const gap::ParameterRange& r) {
    boundary("low", r.low);
    boundary("high", r.high);
    w.boolean("low_open", r.low_open).boolean("high_open", r.high_open);
  };
  w.begin_object().text("name", p.parameter.name);
  if (!p.parameter.of.empty()) w.text("of", p.parameter.of);
  w.text("unit", p.parameter.unit());
  boundary("start", p.start);
  boundary("value", p.value);
  if (p.std) boundary("std", *p.std);
  if (p.prior_std) boundary("prior_std", *p.prior_std);
  w.key("interval").begin_object();
  range({p.low, p.high, p.low_open, p.high_open});
  w.end_object();
  if (p.with_assumed) {
    w.key("interval_with_assumed").begin_object();
    range(*p.with_assumed);
    w.texts("assumed", p.assumed).end_object();
  }
  w.text("determination", gap::name_of(p.determination)).boolean("on_bound", p.on_bound);
  w.text("words", p.words).end_object();
}

void write_estimate(Writer& w, const gap::SoilEstimate& e) {
  w.begin_object().key("parameters").begin_array();
  for (const EstimatedParameter& p : e.parameters) write_parameter(w, p);
  w.end_array().key("correlations").begin_array();
  for (std::size_t a = 0; a < e.parameters.size(); ++a)
    for (std::size_t b = a + 1; b < e.parameters.size(); ++b) {
      w.begin_object().text("first", e.parameters[a].parameter.shown());
      w.text("second", e.parameters[b].parameter.shown());
      w.significant("value", e.correlation(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)));
      w.end_object();
    }
  w.end_array().key("undetermined_directions").begin_array();
  for (const gap::OpenDirection& open : e.open)
    w.begin_object().text("words", open.words).significant("share", open.share).end_object();
  w.end_array().significant("width_m", e.width_m).boolean("converged", e.converged);
  if (!e.data.empty()) {
    w.significant("residual_variance", e.residual_variance);
    w.significant("max_residual_variance", e.max_residual_variance).boolean("model_holds", e.model_holds);
    w.whole("evaluations", static_cast<std::int64_t>(e.evaluations));
    w.whole("sunk", static_cast<std::int64_t>(e.sunk));
    w.key("channels").begin_array();
    for (const gap::ChannelResidual& c : e.channels) {
      w.begin_object().text("channel", gap::name_of(c.channel)).text("unit", gap::unit_of(c.channel));
      w.whole("count", static_cast<std::int64_t>(c.count)).significant("rms", c.rms);
      w.significant("rms_deviations", c.rms_deviations).end_object();
    }
    w.end_array().key("readings").begin_array();
    for (const gap::FittedDatum& d : e.data) {
      w.begin_object().whole("test", static_cast<std::int64_t>(d.datum.test));
      if (d.datum.channel == gap::SoilChannel::kPressure)
        w.whole("sample", static_cast<std::int64_t>(d.datum.sample));
      w.text("channel", gap::name_of(d.datum.channel)).significant("measured", d.datum.measured);
      w.significant("fitted", d.fitted).significant("std", d.datum.std).boolean("outlier", d.outlier);
      w.end_object();
    }
    w.end_array();
  }
  w.texts("notes", e.notes);
  write_soil(w.key("soil"), e.soil);
  if (!e.further_soils.empty()) {
    w.key("further_soils").begin_array();
    for (const sim::SoilDistribution& soil : e.further_soils) write_soil(w, soil);
    w.end_array();
  }
  w.end_object();
}

}  // namespace

std::string soil_estimate_document(const SoilEstimateAnswer& answer) {
  const SoilEstimateRequest& request = answer.request;
  Writer w;
  w.begin_object().text("format", "soil-estimate/1");
  if (request.campaign.empty()) {
    w.text("nominal_soil", answer.nominal);
    w.whole("wheel_tests", static_cast<std::int64_t>(request.data.wheels.size()));
    w.whole("plate_tests", static_cast<std::int64_t>(request.data.plates.size()));
  } else {
    w.text("campaign", request.campaign).whole("windows", static_cast<std::int64_t>(answer.windows));
    w.key("channels").begin_array();
    for (const gap::DriveChannelResidual& c : answer.drive_channels) {
      w.begin_object().text("channel", gap::name_of(c.channel)).text("unit", gap::unit_of(c.channel));
      w.whole("count", static_cast<std::int64_t>(c.count));
      w.significant("rms", gap::boundary_unit(c.channel) * c.rms);
      w.significant("rms_deviations", c.rms_deviations).end_object();
    }
    w.end_array();
  }
  w.key("estimates").begin_array();
  for (const gap::SoilEstimate& e : answer.estimates) write_estimate(w, e);
  w.end_array().key("provenance").begin_object().text("version", version());
  w.whole("seed", static_cast<std::int64_t>(request.options.seed)).end_object().end_object();
  return w.take();
}

std::string estimated_soils_document(const SoilEstimateAnswer& answer) {
  Writer w;
  w.begin_object().text("format", "soils/1").key("soils").begin_array();
  for (const gap::SoilEstimate& e : answer.estimates) {
    write_soil(w, e.soil);
    for (const sim::SoilDistribution& soil : e.further_soils) write_soil(w, soil);
  }
  w.end_array().end_object();
  return w.take();
}

}  // namespace slipway::api::json
