#include "research/documents/search_record_document.h"

#include <cmath>

#include "api/json/writer.h"

namespace slipway::api::json {
namespace {

void write_explanation(Writer& w, const gap::SearchRecord::Explanation& e) {
  w.begin_object().texts("effects", e.effects);
  if (!e.outside.empty()) w.texts("outside", e.outside);
  if (e.with_unknown) w.boolean("with_unknown", true);
  w.whole("fit", static_cast<std::int64_t>(e.fit));
  w.significant("log_evidence", e.log_evidence).significant("log_prior", e.log_prior);
  w.key("other_variants").begin_array();
  for (const std::vector<double>& of_cause : e.other_variants) {
    w.begin_array();
    for (const double less : of_cause) w.significant(std::max(less, -1e6));
    w.end_array();
  }
  w.end_array().end_object();
}

void write_fit(Writer& w, const gap::SearchRecord::Fit& fit) {
  w.begin_object().significant("held_out_rms", fit.held_out_rms).key("shifts").begin_array();
  for (const gap::SearchRecord::Shift& shift : fit.shifts) {
    w.begin_object().text("parameter", shift.parameter).significant("deviations", shift.deviations);
    if (!shift.has_far_ends) w.boolean("has_far_ends", false);
    w.end_object();
  }
  w.end_array().end_object();
}

}  // namespace

std::string search_record_document(const gap::Diagnosis& diagnosis) {
  const gap::SearchRecord& record = diagnosis.search;
  Writer w;
  w.begin_object().text("schema", "search-record/1").text("campaign", diagnosis.campaign);
  w.boolean("with_reference", record.with_reference);
  w.whole("drives", static_cast<std::int64_t>(record.drives));
  w.whole("windows", static_cast<std::int64_t>(record.windows));
  w.key("explanations").begin_array();
  for (const gap::SearchRecord::Explanation& e : record.explanations) write_explanation(w, e);
  w.end_array().key("fits").begin_array();
  for (const gap::SearchRecord::Fit& fit : record.fits) write_fit(w, fit);
  w.end_array().key("causes").begin_array();
  for (const gap::SearchRecord::Cause& cause : record.causes)
    w.begin_object()
        .text("name", cause.name)
        .significant("share", cause.share)
        .significant("beside_others", cause.beside_others)
        .end_object();
  w.end_array().key("scatter_deviations").begin_array();
  for (const double deviations : record.scatter_deviations) w.significant(deviations);
  w.end_array().significant("parameters_gain", record.parameters_gain);
  w.significant("hidden_share", record.hidden_share);
  w.key("channels").begin_array();
  for (const gap::ChannelClosure& c : diagnosis.gap) {
    w.begin_object().text("channel", name_of(c.channel)).significant("nominal", c.nominal.value);
    w.significant("retuned", c.retuned.value).significant("with_effects", c.with_effects.value);
    w.significant("with_effects_low", c.with_effects.low).significant("floor", c.noise_floor.value);
    w.end_object();
  }
  w.end_array().key("decided").begin_object().text("verdict", gap::name_of(diagnosis.verdict));
  w.boolean("partial", diagnosis.partial).text("reason", diagnosis.reason).key("effects").begin_array();
  for (const gap::FoundEffect& effect : diagnosis.effects) w.text(effect.name);
  w.end_array().end_object().end_object();
  return w.take();
}

}  // namespace slipway::api::json
