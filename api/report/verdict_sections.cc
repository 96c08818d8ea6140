#include "api/report/verdict_sections.h"

#include <string>
#include <utility>

#include "api/json/lookup.h"
#include "planner/problem/verdict.h"

namespace slipway::api {

using json::at;
using json::has;
using json::JsonValue;
using json::number;
using json::text;

void add_verdict_banner(ReportPage& page, const JsonValue& document) {
  const std::string& verdict = text(document, "verdict");
  page.banner(std::string(planner::verdict_words(verdict)), verdict == "go"      ? ReportPage::Tone::kGood
                                                            : verdict == "no_go" ? ReportPage::Tone::kBad
                                                                                 : ReportPage::Tone::kOpen);
}

void add_advice(ReportPage& page, const JsonValue& decision) {
  if (text(decision, "verdict") == "go") return;
  page.section("What would change it");
  const auto& advice = at(decision, "advice").elements;
  for (const JsonValue& each : advice) page.item(text(each, "words"));
  const JsonValue& starts = at(decision, "starts");
  const bool hangs_on_start = number(starts, "go") < number(starts, "starts");
  if (hangs_on_start)
    page.item("To know better where the rover stands and how it is turned, before it drives");
  if (advice.empty() && !hangs_on_start)
    page.item("Another way or another goal; no shorter drive and no scout drive does");
  if (has(decision, "departures") && !has(at(decision, "departures"), "best"))
    page.item("Other departures, or more charge: none of those asked for keeps the rules of the day");
}

void add_map(ReportPage& page, Result<std::string> map, std::string_view caption) {
  if (map)
    page.picture({"map", *std::move(map)}, std::string(caption));
  else
    page.paragraph("There is no map here: " + map.error().detail);
}

}  // namespace slipway::api
