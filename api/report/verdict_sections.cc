#include "api/report/verdict_sections.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "api/json/lookup.h"
#include "api/json/writer.h"
#include "planner/problem/verdict.h"

namespace slipway::api {

using json::at;
using json::has;
using json::JsonValue;
using json::number;
using json::text;

namespace {

// The value as JSON on one line, cut where it is long.
std::string shortened(const JsonValue& value) {
  constexpr std::size_t kMost = 900;
  json::Writer w;
  json::write_value(w, value);
  std::string words = w.take();
  if (words.size() > kMost) words = words.substr(0, kMost) + " ... (whole in the JSON answer)";
  return words;
}

}  // namespace

void add_verdict_banner(ReportPage& page, const JsonValue& document) {
  const std::string& verdict = text(document, "verdict");
  page.banner(std::string(planner::verdict_words(verdict)), verdict == "go"      ? ReportPage::Tone::kGood
                                                            : verdict == "no_go" ? ReportPage::Tone::kBad
                                                                                 : ReportPage::Tone::kOpen);
}

std::vector<std::string> what_would_change(const JsonValue& decision) {
  std::vector<std::string> changes;
  for (const JsonValue& each : at(decision, "advice").elements) changes.push_back(text(each, "words"));
  if (has(decision, "otherwise")) changes.push_back(text(decision, "otherwise"));
  return changes;
}

void add_advice(ReportPage& page, const JsonValue& decision) {
  if (text(decision, "verdict") == "go") return;
  page.section("What would change it");
  for (const std::string& words : what_would_change(decision)) page.item(words);
}

void add_map(ReportPage& page, Result<std::string> map, std::string_view caption) {
  if (map)
    page.picture({"map", *std::move(map)}, std::string(caption));
  else
    page.paragraph("There is no map here: " + map.error().detail);
}

void add_provenance(ReportPage& page, const JsonValue& document) {
  const JsonValue& from = at(document, "provenance");
  page.section("Request and provenance");
  page.paragraph(ReportText({{shortened(at(document, "request")), ReportText::Style::kCode}}));
  std::string soils;
  for (const JsonValue& soil : at(from, "soils").elements) soils += (soils.empty() ? "" : ", ") + soil.text;
  page.paragraph(fmt::format(
      "Slipway {}; terrain {} ({}), fingerprint {}; gravity {:g} m/s2; soils {}; where no map names one: {}; "
      "seed {:.0f}{}.",
      text(from, "slipway"), text(from, "terrain_title"), text(from, "crs_name"),
      text(from, "terrain_fingerprint"), number(from, "gravity_m_s2"), soils.empty() ? "none" : soils,
      text(from, "unknown_soil"), number(from, "seed"),
      has(from, "past_drives")
          ? fmt::format(
                "; the ground is what {:.0f} drives of the past and {:.0f} measured metres leave of it",
                number(from, "past_drives"), number(from, "measured_m"))
          : ""));
  if (has(from, "soil_assumption")) page.paragraph(text(from, "soil_assumption"));
}

}  // namespace slipway::api
