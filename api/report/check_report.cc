#include "api/report/check_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "api/chart/report_page.h"
#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/json/writer.h"
#include "api/report/check_charts.h"
#include "api/report/route_map.h"
#include "api/report/verdict_sections.h"
#include "core/number_words.h"
#include "planner/problem/verdict.h"

namespace slipway::api {
namespace {

using json::at;
using json::has;
using json::JsonValue;
using json::number;
using json::text;

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100.0 * share);
}
std::string share_words(const JsonValue& share) {
  return fmt::format("{} ({} to {})", percent(number(share, "value")), percent(number(share, "low")),
                     percent(number(share, "high")));
}
std::string spread_words(const JsonValue& spread) {
  return fmt::format("{:.2f} m ({:.2f} to {:.2f} m)", number(spread, "p50"), number(spread, "p05"),
                     number(spread, "p95"));
}
std::string with_unit(double value, const JsonValue& rule) {
  const std::string& unit = text(rule, "unit");
  return plain_number(value) + (unit == "1" ? "" : " " + unit);
}

void add_verdict(ReportPage& page, const JsonValue& check) {
  add_verdict_banner(page, check);
  const JsonValue &figures = at(check, "summary"), &outcomes = at(check, "outcomes");
  const long minutes = std::lround(number(figures, "duration_s") / 60.0);
  page.paragraph(
      fmt::format("{:.1f} m in {}:{:02d} h of driving. A halt in {} of the draws, immobilised in {}, "
                  "embedded in {}, with "
                  "90 % intervals from {:.0f} draws of the ground.",
                  number(figures, "length_m"), minutes / 60, minutes % 60, share_words(at(outcomes, "stop")),
                  share_words(at(outcomes, "immobilised")), share_words(at(outcomes, "embedding")),
                  number(outcomes, "draws")));
  for (const JsonValue& reason : at(check, "reasons").elements) page.item(reason.text);
  add_advice(page, at(check, "decision"));
}

void add_rules(ReportPage& page, const JsonValue& outcomes) {
  page.section("The rules");
  page.table({"rule", "limit", "value, median", "5 to 95 %", "trips (90 % interval)", "value then",
              "from - to", "wheel", "cause"});
  for (const JsonValue& rule : at(outcomes, "rules").elements) {
    const JsonValue& value = at(rule, "value");
    page.row(
        {text(rule, "words"), with_unit(number(rule, "limit"), rule), with_unit(number(value, "p50"), rule),
         fmt::format("{} to {}", plain_number(number(value, "p05")), plain_number(number(value, "p95"))),
         share_words(at(rule, "trips")),
         has(rule, "tripping_value") ? with_unit(number(at(rule, "tripping_value"), "p50"), rule) : "-",
         has(rule, "from_m") ? fmt::format("{:.1f} - {:.1f} m", number(rule, "from_m"), number(rule, "to_m"))
                             : "-",
         has(rule, "wheel") ? text(rule, "wheel") : "-", has(rule, "cause") ? text(rule, "cause") : "-"});
  }
}

// The worst stretches in their order, and what the others have together.
void add_stretches(ReportPage& page, const JsonValue& check) {
  constexpr std::size_t kMostShown = 8;
  const auto wrong = [](const JsonValue& s) { return number(s, "expected_stops") + number(s, "embedding"); };
  const JsonValue& stretches = at(at(check, "outcomes"), "stretches");
  const JsonValue& behind = at(at(check, "position_uncertainty"), "stretches");
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < std::min(stretches.elements.size(), behind.elements.size()); ++k)
    order.push_back(k);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return wrong(stretches.elements[a]) > wrong(stretches.elements[b]);
  });
  const std::size_t shown = std::min(kMostShown, order.size());
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(shown));
  page.section("Stretches");
  page.table({"from - to", "halts here first", "embedding",
              "behind the commanded way at its end, median (90 % interval)"});
  for (std::size_t k = 0; k < shown; ++k) {
    const JsonValue& stretch = stretches.elements[order[k]];
    page.row({fmt::format("{:.1f} - {:.1f} m", number(stretch, "from_m"), number(stretch, "to_m")),
              percent(number(stretch, "expected_stops")), percent(number(stretch, "embedding")),
              spread_words(at(behind.elements[order[k]], "shortfall_m"))});
  }
  if (shown < order.size()) {
    double rest = 0.0;
    for (std::size_t k = shown; k < order.size(); ++k) rest += wrong(stretches.elements[order[k]]);
    page.paragraph(fmt::format("The other {} stretches have {:.3f} halts and embeddings together.",
                               order.size() - shown, rest));
  }
}

void add_position(ReportPage& page, const JsonValue& check) {
  const JsonValue& uncertainty = at(check, "position_uncertainty");
  const JsonValue& heading = at(uncertainty, "heading_deg");
  page.section("Where the rover ends");
  page.item(fmt::format(
      "Commanded by the way its wheels roll and without a look at where it is, the rover ends {} behind the "
      "end of its {:.1f} m, {} to the left of it and {:.1f} deg ({:.1f} to {:.1f} deg) off its heading. "
      "Median "
      "and 90 % interval",
      spread_words(at(uncertainty, "shortfall_m")), number(uncertainty, "commanded_m"),
      spread_words(at(uncertainty, "cross_track_m")), number(heading, "p50"), number(heading, "p05"),
      number(heading, "p95")));
  page.item(fmt::format("At most {} are lost between two checks of the slip",
                        spread_words(at(uncertainty, "between_checks_m"))));
}

}  // namespace

Result<std::string> check_report(const Catalogue& catalogue, std::string_view answer) {
  const auto check = json::parse(answer, {.bytes = answer.size(), .values = answer.size()});
  if (!check) return fail(check.error());
  if (text(*check, "format") != "check/1") return fail(ErrorCode::kInternal, "the answer is not a check");
  ReportPage page(
      fmt::format("May this drive be commanded? {} on {}", text(*check, "rover"), text(*check, "terrain")));
  add_verdict(page, *check);
  add_rules(page, at(*check, "outcomes"));
  // A rover that is stuck where it stands has no line to draw.
  if (auto map = draw_outcome_map(catalogue, *check); map || map.error().code != ErrorCode::kNoData)
    add_map(page, std::move(map), "The path by the halts and embeddings that are expected on each stretch");
  add_position(page, *check);
  add_stretches(page, *check);
  page.picture(draw_check(*check),
               "Against the limits of the request; halts, embeddings and the error of the position");
  add_provenance(page, *check);
  return page.html();
}

}  // namespace slipway::api
