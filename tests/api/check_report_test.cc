// What is made of a check's answer: the page for a meeting, the advice in it, the stations as CSV.
#include "api/report/check_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "api/chart/chart.h"
#include "api/documents/check_answer.h"
#include "api/documents/plan_answer.h"
#include "api/export/station_csv.h"
#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/service_drives.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using json::JsonValue;

std::string answered(const std::string& members) {
  const Service& service = testing::small_world();
  const auto read = read_check(service, R"({"terrain":"yard","rover":"mer-class",)" + members + "}");
  EXPECT_TRUE(read) << read.error().detail;
  NoProgress progress;
  const auto answer = run_check(service, *read, progress);
  EXPECT_TRUE(answer) << answer.error().detail;
  return json::write_check_answer(*answer);
}

const std::string kPath = R"("path":[{"x_m":20,"y_m":30},{"x_m":44,"y_m":30}],"draws":8)";

TEST(CheckReport, HoldsTheVerdictTheRulesTheMapAndTheChartsAndLoadsNothing) {
  const std::string answer = answered(kPath);
  const auto page = check_report(*testing::small_world().catalogue(), answer);
  ASSERT_TRUE(page) << page.error().detail;
  const auto check = json::parse(answer);
  const std::string& verdict = json::text(*check, "verdict");
  const std::string words = verdict == "go" ? ">GO<" : verdict == "no_go" ? ">NO-GO<" : ">UNKNOWN<";
  for (const std::string& part :
       {words, std::string("What would change it"), std::string("slip_check"),
        std::string("data:image/png;base64,"), std::string("Slip</text>"),
        std::string("Where the rover ends"), std::string("Behind the commanded way"),
        std::string("fingerprint"), std::string("prefers-color-scheme:dark")})
    EXPECT_NE(page->find(part), std::string::npos) << part;
  for (const JsonValue& reason : json::at(*check, "reasons").elements)
    EXPECT_NE(page->find(xml_text(reason.text)), std::string::npos) << reason.text;
  for (const char* const outside : {"<script", "src=", "<link", "href=\"http", "@import"})
    EXPECT_EQ(page->find(outside), std::string::npos) << outside;
  EXPECT_EQ(*page, *check_report(*testing::small_world().catalogue(), answer)) << "the same bytes";
  EXPECT_FALSE(check_report(*testing::small_world().catalogue(), R"({"format":"plan/1"})"));
}

TEST(CheckReport, DrawsTheAreasOfTheRequestWithinTheMap) {
  const Catalogue& catalogue = *testing::small_world().catalogue();
  const std::string zones =
      R"(,"keep_out":[[[30,32],[34,32],[32,36]]],"keep_in":[[[0,20],[900,20],[900,40],[0,40]]])";
  const std::string with = *check_report(catalogue, answered(kPath + zones));
  const std::string without = *check_report(catalogue, answered(kPath));
  for (const char* const part :
       {">keep-out</text>", ">edge of a keep-in</text>", "clip-path=\"url(#map-map)\""}) {
    EXPECT_NE(with.find(part), std::string::npos) << part;
    EXPECT_EQ(without.find(part), std::string::npos) << part;
  }
}

// A page on a NO-GO or an UNKNOWN commands nothing, and what would change it is the answer's own advice.
TEST(CheckReport, SaysWhatWouldChangeItAndHeadsNothingAsACommand) {
  const std::string answer = answered(kPath + std::string(R"(,"limits":{"max_sinkage_m":0.001})"));
  const auto check = json::parse(answer);
  ASSERT_EQ(json::text(*check, "verdict"), "no_go");
  const auto page = check_report(*testing::small_world().catalogue(), answer);
  ASSERT_TRUE(page);
  EXPECT_NE(page->find("NO-GO"), std::string::npos);
  EXPECT_NE(page->find("What would change it"), std::string::npos);
  EXPECT_NE(page->find("sinkage of a wheel"), std::string::npos);
  for (const char* const unwanted : {"To be commanded", ">margin<", "sols expected"})
    EXPECT_EQ(page->find(unwanted), std::string::npos) << unwanted;
}

std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string>& cells = rows.emplace_back(1);
    for (const char c : line) {
      if (c == ',')
        cells.emplace_back();
      else
        cells.back() += c;
    }
  }
  return rows;
}

TEST(StationCsv, HasARowAStationWithTheDocumentsFiguresAndTheEnergyUpToThere) {
  const std::string answer = answered(kPath);
  const auto csv = json::station_csv(answer);
  ASSERT_TRUE(csv) << csv.error().detail;
  const auto rows = rows_of(*csv);
  const auto check = json::parse(answer);
  const JsonValue& stations = json::at(
      json::at(json::at(json::at(*check, "routes"), "features").elements[0], "properties"), "stations");
  ASSERT_EQ(rows.size(), 1 + static_cast<std::size_t>(json::number(stations, "count")));
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin());
  };
  for (const char* const name : {"distance_m", "slip_p95", "tilt_deg", "embedding", "expected_stops"}) {
    ASSERT_LT(column(name), rows[0].size()) << name;
    const auto values = json::numbers(stations, name);
    for (std::size_t k = 0; k < values.size(); ++k)
      EXPECT_EQ(std::stod(rows[k + 1][column(name)]), values[k]);
  }
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  const double energy_wh = json::number(json::at(*check, "summary"), "energy_wh");
  EXPECT_NEAR(std::stod(rows.back()[column("energy_wh")]), energy_wh, 1e-3 * energy_wh);
  EXPECT_FALSE(json::station_csv(R"({"format":"diagnosis/1"})"));
  EXPECT_TRUE(json::has_stations(answer));
  EXPECT_FALSE(json::has_stations(R"({"format":"diagnosis/1"})"));
}

TEST(StationCsv, OfAPlanBeginsWithTheRank) {
  const Service& service = testing::small_world();
  const auto read = read_plan(
      service,
      R"({"terrain":"yard","rover":"mer-class","start":{"x_m":20,"y_m":30},"goal":{"x_m":30,"y_m":34},"routes":2,"draws":2})");
  ASSERT_TRUE(read);
  NoProgress progress;
  const auto plan = run_plan(service, *read, progress);
  ASSERT_TRUE(plan) << plan.error().detail;
  const std::string answer = json::write_plan_answer(*plan);
  const auto rows = rows_of(*json::station_csv(answer));
  EXPECT_EQ(rows[0][0], "route");
  EXPECT_EQ(rows[1][0], "1");
  EXPECT_EQ(rows.back()[0], std::to_string(plan->plan.routes.size()));
  EXPECT_NE(answer.find("\"pareto\":true"), std::string::npos) << "some route is dominated by none";
}

TEST(PositionUncertainty, GrowsAlongTheWayAndIsBoundedByTheSlipBetweenChecks) {
  const auto check = json::parse(answered(R"("path":[{"x_m":20,"y_m":30},{"x_m":50,"y_m":30}],"draws":16)"));
  const JsonValue& uncertainty = json::at(*check, "position_uncertainty");
  const auto& stretches = json::at(uncertainty, "stretches").elements;
  ASSERT_EQ(stretches.size(), 3U);
  for (const JsonValue& stretch : stretches) {
    const JsonValue& behind = json::at(stretch, "shortfall_m");
    EXPECT_LE(json::number(behind, "p05"), json::number(behind, "p50"));
    EXPECT_LE(json::number(behind, "p50"), json::number(behind, "p95"));
    EXPECT_LT(json::number(behind, "p95"), json::number(stretch, "to_m"));
  }
  EXPECT_EQ(json::number(uncertainty, "commanded_m"), json::number(stretches.back(), "to_m"));
  EXPECT_EQ(json::number(json::at(uncertainty, "shortfall_m"), "p95"),
            json::number(json::at(stretches.back(), "shortfall_m"), "p95"));
  // On level ground all stretches slip alike: as the median slip says, within its spread.
  const double slip = json::number(json::at(*check, "summary"), "mean_slip");
  EXPECT_NEAR(json::number(json::at(uncertainty, "shortfall_m"), "p50"), 30.0 * slip, 30.0 * 0.1);
}

}  // namespace
}  // namespace slipway::api
