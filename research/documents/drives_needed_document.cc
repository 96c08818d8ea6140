#include "research/documents/drives_needed_document.h"

#include "api/json/writer.h"

namespace slipway::api::json {

std::string drives_needed_document(const gap::DrivesNeeded& needed) {
  const gap::DrivesNeededSummary s = gap::summary_of(needed.cases, needed.first);
  const auto whole = [](std::size_t count) { return static_cast<std::int64_t>(count); };
  Writer w;
  w.begin_object().text("format", "drives-needed/1");
  w.whole("seed", static_cast<std::int64_t>(needed.seed)).whole("first_drives", whole(needed.first));
  w.key("campaigns").begin_array();
  for (const gap::DrivesNeededCase& c : needed.cases) {
    w.begin_object().text("campaign", c.campaign).text("hidden", c.hidden).text("kind", c.kind);
    w.text("fidelity", c.fidelity).whole("limit", whole(c.limit));
    if (c.designed) w.whole("designed", whole(*c.designed));
    w.key("random").begin_array();
    for (const auto& found : c.random) {
      if (found)
        w.whole(whole(*found));
      else
        w.null();
    }
    w.end_array();
    if (const auto median = c.random_median()) w.significant("random_median", *median);
    if (const auto ratio = c.ratio(needed.first)) w.significant("ratio", *ratio);
    w.end_object();
  }
  w.end_array().key("summary").begin_object();
  w.whole("campaigns", whole(s.campaigns)).whole("compared", whole(s.compared));
  w.whole("first_enough", whole(s.first_enough)).whole("designed_not_found", whole(s.designed_not_found));
  w.whole("random_runs", whole(s.random_runs)).whole("random_not_found", whole(s.random_not_found));
  if (s.median_ratio) w.significant("median_ratio", *s.median_ratio);
  if (s.ratio_low)
    w.key("interval_90").begin_array().significant(*s.ratio_low).significant(*s.ratio_high).end_array();
  return w.end_object().end_object().take() + "\n";
}

}  // namespace slipway::api::json
