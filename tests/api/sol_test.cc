// A sol: the plan of a day, the start's error, and the way back out of the worst place.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "api/documents/sol_document.h"
#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/json/writer.h"
#include "api/report/command_rows.h"
#include "api/report/sol_report.h"
#include "api/service_sol.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using json::at;
using json::has;
using json::JsonValue;
using json::number;
using json::text;
using testing::small_world;

// The sun stands in the east from 6 h on and sinks behind the level at 18 h.
std::string sol_request(const std::string& more, const std::string& day = "") {
  return R"({"terrain":"yard","rover":"mer-class","start":{"x_m":20,"y_m":30},"goal":{"x_m":34,"y_m":30},)"
         R"("routes":1,"draws":16,"departure":{"from":"2026-07-01T08:00:00Z","charge_percent":90,)" +
         day +
         R"("sky":[{"at":"2026-07-01T00:00:00Z","sun_azimuth_deg":0,"sun_elevation_deg":-90},)"
         R"({"at":"2026-07-01T06:00:00Z","sun_azimuth_deg":90,"sun_elevation_deg":0},)"
         R"({"at":"2026-07-01T12:00:00Z","sun_azimuth_deg":90,"sun_elevation_deg":89.9},)"
         R"({"at":"2026-07-01T18:00:00Z","sun_azimuth_deg":269,"sun_elevation_deg":0},)"
         R"({"at":"2026-07-02T00:00:00Z","sun_azimuth_deg":269,"sun_elevation_deg":-89}]})" +
         more + "}";
}

std::string sol_of(const std::string& request) {
  const auto read = read_sol(small_world(), request);
  EXPECT_TRUE(read) << (read ? "" : read.error().faults.front().message);
  NoProgress progress;
  const auto answer = run_sol(small_world(), *read, progress);
  EXPECT_TRUE(answer) << (answer ? "" : answer.error().detail);
  return json::write_sol(*answer);
}

const JsonValue& decision_of(const JsonValue& sol) {
  return at(at(at(at(at(sol, "plan"), "routes"), "features").elements.front(), "properties"), "decision");
}

const JsonValue* rule_of(const JsonValue& decision, const std::string& name) {
  for (const JsonValue& rule : at(decision, "rules").elements)
    if (text(rule, "rule") == name) return &rule;
  return nullptr;
}

TEST(Sol, TheStartsErrorIsARuleOfItsVerdictAndItsPage) {
  const std::string document = sol_of(sol_request(R"(,"start_error":{"position_m":0.4,"heading_deg":2})"));
  const JsonValue sol = json::parse(document).value();
  EXPECT_EQ(number(at(at(at(sol, "plan"), "request"), "start_error"), "heading_deg"), 2.0);
  const JsonValue& starts = at(decision_of(sol), "starts");
  EXPECT_EQ(number(starts, "starts"), 25.0);
  EXPECT_EQ(number(starts, "go") + number(starts, "unknown") + number(starts, "no_go"), 25.0);
  const JsonValue* const rule = rule_of(decision_of(sol), "start");
  ASSERT_NE(rule, nullptr);
  EXPECT_EQ(text(*rule, "verdict") == "go", number(starts, "go") == 25.0);
  const auto page = sol_report(*small_world().catalogue(), document);
  ASSERT_TRUE(page);
  EXPECT_NE(page->find("If it does not start where it is said to"), std::string::npos);
  EXPECT_NE(page->find("starts that are wrong by 0.4 m and 2 deg (1 sigma)"), std::string::npos);
}

// A keep-out that the way passes, and that the rover would enter from some of its starts.
TEST(Sol, IsNoGoAheadWhereADisplacedStartBreaksARule) {
  const JsonValue sol = json::parse(sol_of(sol_request(R"(,"start_error":{"position_m":2,"heading_deg":8},)"
                                                       R"("keep_out":[[[26,32],[30,32],[30,34],[26,34]]])")))
                            .value();
  EXPECT_NE(text(sol, "verdict"), "go");
  const JsonValue& worst = at(at(decision_of(sol), "starts"), "worst");
  EXPECT_EQ(text(at(worst, "rule"), "rule"), "keep_out");
  EXPECT_TRUE(has(worst, "left_m"));
}

TEST(Sol, AStartErrorThatIsNoneIsRefusedAtItsPlace) {
  const auto faults_of = [](const std::string& error) {
    std::vector<std::string> pointers;
    const auto read = read_sol(small_world(), sol_request(R"(,"start_error":)" + error));
    if (!read)
      for (const Fault& fault : read.error().faults) pointers.push_back(fault.pointer);
    return pointers;
  };
  using Places = std::vector<std::string>;
  EXPECT_EQ(faults_of(R"({"position_m":-0.1})"), Places{"/start_error/position_m"});
  EXPECT_EQ(faults_of(R"({"position_m":400,"heading_deg":90})"),
            (Places{"/start_error/position_m", "/start_error/heading_deg"}));
  EXPECT_EQ(faults_of(R"({"heading_rad":0.1})"), Places{"/start_error/heading_rad"});
  EXPECT_EQ(faults_of("0.3"), Places{"/start_error"});
  EXPECT_EQ(faults_of(R"({"position_m":0})"), Places{});
}

TEST(Sol, TheWayBackHasTheDayThatIsLeft) {
  const std::string day =
      R"("min_sun_deg":5,"min_charge_percent":20,"light_left_h":0.5,"arrive_by":"2026-07-01T12:00:00Z",)";
  const JsonValue sol = json::parse(sol_of(sol_request("", day))).value();
  ASSERT_TRUE(has(sol, "worst"));
  ASSERT_TRUE(has(sol, "back_out"));
  const JsonValue& back = at(sol, "back_out");
  // The route's own commands, the last first.
  const JsonValue& request = at(back, "request");
  double back_m = 0.0;
  for (const JsonValue& command : at(request, "commands").elements)
    back_m += has(command, "drive_m") ? number(command, "drive_m")
              : has(command, "arc_m") ? number(command, "arc_m")
                                      : 0.0;
  EXPECT_NEAR(back_m, number(at(sol, "worst"), "at_m"), 0.01);
  EXPECT_TRUE(at(request, "backwards").boolean);
  const JsonValue& asked = at(request, "departure");
  EXPECT_EQ(text(asked, "from"), text(asked, "to"));
  EXPECT_FALSE(has(asked, "arrive_by"));
  const JsonValue& departures = at(decision_of(sol), "departures");
  const JsonValue& drive = at(departures, has(departures, "best") ? "best" : "nearest");
  EXPECT_GE(text(asked, "from"), text(drive, "departs"));
  EXPECT_LE(text(asked, "from"), text(drive, "arrives_late"));
  double held = 100.0;
  for (const JsonValue& station : at(drive, "stations").elements)
    if (number(station, "distance_m") <= number(at(sol, "worst"), "at_m") + 1e-3)
      held = number(station, "charge_low_percent");
  EXPECT_NEAR(number(asked, "charge_percent"), held, 0.5);
  for (const char* const name : {"charge", "sun", "light_left"})
    EXPECT_NE(rule_of(at(back, "decision"), name), nullptr) << name;
  EXPECT_EQ(rule_of(at(back, "decision"), "arrival"), nullptr);
}

// A minute before the sun sets the drive may still end in its light, but not the way back.
TEST(Sol, InTheDarkThereIsNoWayBack) {
  std::string request = sol_request("", R"("min_sun_deg":1,)");
  const std::string from = R"("from":"2026-07-01T08:00:00Z")";
  request.replace(request.find(from), from.size(), R"("from":"2026-07-01T17:50:00Z")");
  const JsonValue sol = json::parse(sol_of(request)).value();
  ASSERT_TRUE(has(sol, "back_out"));
  const JsonValue* const sun = rule_of(at(at(sol, "back_out"), "decision"), "sun");
  ASSERT_NE(sun, nullptr);
  EXPECT_EQ(text(*sun, "verdict"), "no_go");
}

// The page can be driven from: the pose, each command with its place, and what is assumed of slip checks.
TEST(Sol, ThePageHasThePoseAndThePlacesOfItsCommands) {
  const std::string document = sol_of(sol_request("", R"("arrive_by":"2026-07-01T12:00:00Z",)"));
  const auto page = sol_report(*small_world().catalogue(), document);
  ASSERT_TRUE(page);
  const JsonValue sol = json::parse(document).value();
  const JsonValue& route = at(at(sol, "plan"), "summary").elements.front();
  for (const std::string& part :
       {start_words(at(route, "start")), way_words(command_rows(at(route, "commands"), {}).back()),
        std::string("the slip is checked every 5 m"), std::string("2026-07-01 08:00 UTC"),
        std::string("The time is enough: the rover arrives at 2026-07-01 "),
        std::string("before the limit of 2026-07-01 12:00 UTC")})
    EXPECT_NE(page->find(part), std::string::npos) << part;
  const std::string words = page->substr(0, page->find("Request and provenance</h2>"));
  for (const char* const unwanted : {"00.000Z", "before 0.0 m", "Nearest", "<td>drive_m"})
    EXPECT_EQ(words.find(unwanted), std::string::npos) << unwanted;
}

TEST(Sol, ThePageHasTheCommandsOfTheWayBack) {
  const std::string document = sol_of(sol_request(""));
  const JsonValue sol = json::parse(document).value();
  ASSERT_TRUE(has(sol, "back_out"));
  const JsonValue& asked = at(at(sol, "back_out"), "request");
  const auto page = sol_report(*small_world().catalogue(), document);
  ASSERT_TRUE(page);
  EXPECT_NE(page->find(start_words(at(asked, "start"))), std::string::npos);
  EXPECT_NE(page->find(way_words(command_rows(at(asked, "commands"), {}).front())), std::string::npos);
  EXPECT_NE(page->find("driven backwards"), std::string::npos);
}

// A title that is longer than the legend is wide has several lines.
TEST(Sol, TheMapsTitleFitsItsLegend) {
  const auto page = sol_report(*small_world().catalogue(), sol_of(sol_request("")));
  ASSERT_TRUE(page);
  EXPECT_EQ(page->find(">A yard of 120 m by 100 m on Mars: a gentle rise"), std::string::npos);
  EXPECT_NE(page->find(">A yard of 120 m by 100 m on Mars:</text>"), std::string::npos);
}

}  // namespace
}  // namespace slipway::api
