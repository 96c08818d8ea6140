#include "research/documents/benchmark_document.h"

#include <array>
#include <string_view>
#include <utility>

#include "api/json/writer.h"
#include "research/benchmark/benchmark_figures.h"

namespace slipway::api::json {
namespace {

using gap::BenchmarkFigures;
using gap::CaseScore;
using gap::Rate;

void write_rate(Writer& w, std::string_view name, const Rate& rate) {
  const gap::RateInterval interval = gap::binomial_interval(rate);
  w.key(name).begin_object().whole("hits", static_cast<std::int64_t>(rate.hits));
  w.whole("of", static_cast<std::int64_t>(rate.of));
  if (rate.of > 0) {
    w.significant("value", rate.value());
    w.key("interval_90").begin_array().significant(interval.low).significant(interval.high).end_array();
  }
  w.end_object();
}

void write_optional(Writer& w, std::string_view name, const std::optional<double>& value) {
  if (value) w.significant(name, *value);
}

void write_figures(Writer& w, const BenchmarkFigures& f) {
  w.whole("campaigns", static_cast<std::int64_t>(f.cases));
  const std::array<std::pair<std::string_view, const Rate*>, 17> rates{
      {{"exact", &f.exact},
       {"alike", &f.alike},
       {"exact_size_1", &f.exact_sized},
       {"alike_size_1", &f.alike_sized},
       {"set_holds_truth", &f.held},
       {"verdict_right", &f.verdict_right},
       {"false_alarm_nothing", &f.alarm_nothing},
       {"false_alarm_parameters", &f.alarm_parameters},
       {"unknown_told", &f.unknown_reported},
       {"confident_wrong", &f.confident_wrong},
       {"names_right", &f.names_right},
       {"wrong_name", &f.wrong_name},
       {"outside_without_name", &f.outside_unnamed},
       {"wheel_right", &f.wheel_right},
       {"place_overlap_half", &f.overlap},
       {"channel_right", &f.channel_right},
       {"slice_overlap_half", &f.slice_half}}};
  for (const auto& [name, rate] : rates) write_rate(w, name, *rate);
  write_optional(w, "unknown_auroc", f.unknown_auroc);
  write_optional(w, "calibration_error", f.calibration);
  write_optional(w, "brier", f.brier);
  write_optional(w, "closed_fraction_median", f.closed_fraction);
  write_optional(w, "closed_of_oracle_median", f.closed_of_oracle);
  write_optional(w, "place_overlap_median", f.place_overlap);
  write_optional(w, "slice_overlap_median", f.slice_overlap);
  write_optional(w, "slice_overlap_of_attainable_median", f.slice_of_attainable);
  write_optional(w, "seconds_median", f.seconds);
  w.key("marginals_reliability").begin_array();
  for (const gap::ReliabilityBin& bin : f.reliability) {
    w.begin_object().significant("from", bin.from).significant("to", bin.to);
    if (bin.right.of > 0) w.significant("mean_probability", bin.mean_probability);
    write_rate(w, "right", bin.right);
    w.end_object();
  }
  w.end_array();
}

void write_case(Writer& w, const CaseScore& c) {
  w.begin_object().text("campaign", c.campaign).text("hidden", c.truth).significant("size", c.size);
  w.text("kind", c.kind).text("fidelity", c.fidelity).text("verdict", c.verdict).text("found", c.found);
  w.boolean("exact", c.exact).boolean("alike", c.alike).boolean("verdict_right", c.verdict_right);
  w.boolean("set_holds_truth", c.held).boolean("false_alarm", c.false_alarm);
  w.boolean("confident_wrong", c.confident_wrong).boolean("partial", c.partial);
  w.boolean("names_right", c.names_right).boolean("wrong_name", c.wrong_name);
  w.significant("stated", c.stated);
  w.significant("unknown_probability", c.unknown_probability);
  if (c.wheel_right) w.boolean("wheel_right", *c.wheel_right);
  write_optional(w, "closed_fraction", c.closed_fraction);
  write_optional(w, "oracle_closed_fraction", c.oracle_closed_fraction);
  write_optional(w, "place_overlap", c.place_overlap);
  if (c.channel_right) w.boolean("channel_right", *c.channel_right);
  write_optional(w, "slice_overlap", c.slice_overlap);
  write_optional(w, "slice_attainable", c.slice_attainable);
  w.significant("seconds", c.seconds).end_object();
}

}  // namespace

std::string benchmark_document(const gap::Benchmark& benchmark) {
  Writer w;
  w.begin_object().text("format", "gap-benchmark/1").text("variant", benchmark.variant);
  w.key("figures").begin_object();
  for (const auto& [name, cases] : benchmark_groups(benchmark)) {
    w.key(name).begin_object();
    write_figures(w, gap::figures_of(cases));
    w.end_object();
  }
  w.end_object().key("campaigns").begin_array();
  for (const CaseScore& c : benchmark.cases) write_case(w, c);
  w.end_array().key("confusion").begin_object();
  for (const auto& [truth, found] : gap::confusion_of(benchmark.cases)) {
    w.key(truth).begin_object();
    for (const auto& [name, count] : found) w.whole(name, count);
    w.end_object();
  }
  w.end_object().key("withheld").begin_array();
  for (const gap::WithheldScore& s : benchmark.withheld) {
    w.begin_object().text("campaign", s.campaign).text("effect", s.withheld).text("verdict", s.verdict);
    w.text("found", s.found).boolean("unknown", s.unknown).boolean("look_alike", s.look_alike);
    w.boolean("absorbed", s.absorbed).boolean("declared", s.declared).end_object();
  }
  return w.end_array().end_object().take() + "\n";
}

}  // namespace slipway::api::json
