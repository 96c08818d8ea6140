#include "research/validation/document.h"

#include "api/json/writer.h"

namespace slipway::validation {
namespace {

using api::json::Writer;

void write_case(Writer& w, const Case& c) {
  w.begin_object().text("case", c.name).text("quantity", c.quantity).text("unit", c.unit);
  w.significant("measured", c.measured);
  if (c.predicted) {
    w.significant("predicted", *c.predicted).significant("error", *c.predicted - c.measured);
    if (c.measured != 0.0) w.significant("relative_error", *c.predicted / c.measured - 1.0);
  }
  w.end_object();
}

void write_report(Writer& w, const Outcome& outcome) {
  const Report& report = outcome.report;
  w.begin_object().text("name", outcome.comparison->name).text("title", report.title);
  w.text("source", report.source).text("peers", report.peers).boolean("holds", report.holds());
  w.key("bands").begin_array();
  for (const StatedBand& band : report.bands)
    w.begin_object()
        .text("what", band.what)
        .significant("value", band.value)
        .significant("lowest", band.lowest)
        .significant("highest", band.highest)
        .boolean("holds", band.holds())
        .end_object();
  w.end_array();
  w.key("cases").begin_array();
  for (const Case& c : report.cases) write_case(w, c);
  w.end_array().texts("notes", report.notes).end_object();
}

}  // namespace

std::string document_of(std::span<const Outcome> outcomes) {
  bool all = true;
  for (const Outcome& outcome : outcomes) all = all && outcome.report.holds();
  Writer w;
  w.begin_object().text("format", "research/validation/1").boolean("holds", all);
  w.key("comparisons").begin_array();
  for (const Outcome& outcome : outcomes) write_report(w, outcome);
  w.end_array().end_object();
  return w.take();
}

}  // namespace slipway::validation
