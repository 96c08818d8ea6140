#include "research/documents/search_record_document.h"

#include <cmath>

#include "api/json/parse.h"
#include "api/json/strict_reader.h"
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

constexpr CountRule kAny{0, 100'000};
constexpr NumberRule kNumber{.unit = "1"};
constexpr std::int64_t kMost = 1'000'000;

gap::SearchRecord::Explanation read_explanation(ObjectReader reader) {
  gap::SearchRecord::Explanation e;
  std::int64_t fit = 0;
  reader.texts("effects", kRequired, kAny, {}, e.effects);
  reader.texts("outside", kOptional, kAny, {}, e.outside);
  reader.boolean("with_unknown", kOptional, e.with_unknown);
  reader.whole("fit", kRequired, std::int64_t{0}, kMost, fit);
  e.fit = static_cast<std::size_t>(fit);
  reader.number("log_evidence", kRequired, kNumber, e.log_evidence);
  reader.number("log_prior", kRequired, kNumber, e.log_prior);
  for (const Element& of_cause : reader.list("other_variants", kRequired, kAny)) {
    std::vector<double>& less = e.other_variants.emplace_back();
    for (const JsonValue& value : of_cause.value->elements) less.push_back(value.number);
  }
  return e;
}

gap::SearchRecord::Fit read_fit(ObjectReader reader) {
  gap::SearchRecord::Fit fit;
  reader.number("held_out_rms", kRequired, kNumber, fit.held_out_rms);
  for (const Element& element : reader.list("shifts", kRequired, kAny)) {
    ObjectReader of = reader.object(element);
    gap::SearchRecord::Shift& shift = fit.shifts.emplace_back();
    of.text("parameter", kRequired, {}, shift.parameter);
    of.number("deviations", kRequired, kNumber, shift.deviations);
    of.boolean("has_far_ends", kOptional, shift.has_far_ends);
  }
  return fit;
}

}  // namespace

Result<gap::SearchRecord> read_search_record(std::string_view bytes, std::string_view file) {
  const auto document = parse_file(bytes, file, {.bytes = std::size_t{16} << 20U});
  if (!document) return fail(document.error());
  std::vector<Fault> faults;
  std::vector<std::string> passed_over;  // what a decision does not need
  ObjectReader reader(*document, "", faults, &passed_over);
  gap::SearchRecord record;
  std::int64_t drives = 0, windows = 0;
  reader.boolean("with_reference", kRequired, record.with_reference);
  reader.whole("drives", kRequired, std::int64_t{0}, kMost, drives);
  reader.whole("windows", kRequired, std::int64_t{0}, kMost, windows);
  record.drives = static_cast<std::size_t>(drives);
  record.windows = static_cast<std::size_t>(windows);
  for (const Element& element : reader.list("explanations", kRequired, kAny))
    record.explanations.push_back(read_explanation(reader.object(element)));
  for (const Element& element : reader.list("fits", kRequired, kAny))
    record.fits.push_back(read_fit(reader.object(element)));
  for (const Element& element : reader.list("causes", kRequired, kAny)) {
    ObjectReader of = reader.object(element);
    gap::SearchRecord::Cause& cause = record.causes.emplace_back();
    of.text("name", kRequired, {}, cause.name);
    of.number("share", kRequired, kNumber, cause.share);
  }
  reader.numbers("scatter_deviations", kRequired, kAny, kNumber, record.scatter_deviations);
  reader.number("parameters_gain", kRequired, kNumber, record.parameters_gain);
  reader.number("hidden_share", kRequired, kNumber, record.hidden_share);
  reader.boolean("drives_changed", kOptional, record.drives_changed);
  for (const gap::SearchRecord::Explanation& e : record.explanations)
    if (e.fit >= record.fits.size()) faults.push_back({"/explanations", "a fit that is not among the fits"});
  if (record.explanations.empty() || record.fits.empty())
    faults.push_back({"/explanations", "a record has at least one explanation and its fit"});
  if (!faults.empty())
    return fail(ErrorCode::kInvalidRequest, std::string(file) + " is no record of a search", faults);
  return record;
}

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
    w.begin_object().text("name", cause.name).significant("share", cause.share).end_object();
  w.end_array().key("scatter_deviations").begin_array();
  for (const double deviations : record.scatter_deviations) w.significant(deviations);
  w.end_array().significant("parameters_gain", record.parameters_gain);
  w.significant("hidden_share", record.hidden_share).boolean("drives_changed", record.drives_changed);
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
