// What people are told of a sol: its commands with their places, and the battery in words.
#include <gtest/gtest.h>

#include <string>

#include "api/json/parse.h"
#include "api/report/command_rows.h"
#include "api/report/day_words.h"
#include "core/utc.h"

namespace slipway::api {
namespace {

json::JsonValue parsed(const std::string& bytes) {
  return json::parse(bytes).value();
}

TEST(CommandRows, HaveTheirPlacesAndTheChecksWithinThem) {
  const auto rows = command_rows(
      parsed(
          R"([{"drive_m":14.91},{"turn_deg":58.2},{"arc_m":1.22,"radius_m":-6.04},{"drive_m":2,"repeat":3}])"),
      parsed(R"([{"at_m":0},{"at_m":9.7},{"at_m":14.91},{"at_m":16.53}])"));
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].words, "drive 14.91 m");
  EXPECT_EQ(way_words(rows[0]), "0.00 - 14.91 m");
  EXPECT_EQ(rows[0].checks, "check the slip at the start, after 9.7 m of it");
  EXPECT_EQ(rows[1].words, "turn 58.2 deg in place");
  EXPECT_EQ(way_words(rows[1]), "14.91 m");
  EXPECT_EQ(rows[1].checks, "");
  EXPECT_EQ(rows[2].words, "arc 1.22 m, radius -6.04 m");
  EXPECT_EQ(rows[2].checks, "check the slip before it");
  EXPECT_EQ(rows[3].words, "drive 2 m, 3 times");
  EXPECT_EQ(way_words(rows[3]), "16.13 - 22.13 m");
  EXPECT_EQ(rows[3].checks, "check the slip after 0.4 m of it");
}

TEST(CommandRows, BeginAtAPoseAndAssumeChecks) {
  EXPECT_EQ(start_words(parsed(R"({"x_m":8142579.73,"y_m":-276648.74,"yaw_deg":162.6})")),
            "Start at (8142579.73, -276648.74) m of the map, heading 162.6 deg");
  EXPECT_EQ(check_place_words(0.0), "at the start");
  EXPECT_EQ(check_place_words(34.0), "before 34.0 m");
  EXPECT_NE(assumed_checks_words(parsed(R"({"checks":{"slip_check_every_m":2.5}})")).find("every 2.5 m"),
            std::string::npos);
}

TEST(DayWords, ABatteryIsEmptyAndNotBelow) {
  EXPECT_EQ(
      battery_words(parsed(R"({"charge_percent":95.2,"charge_low_percent":94.4,"least_charge_percent":60,)"
                           R"("least_charge_low_percent":55,"rules":[],"stations":[]})"),
                    0),
      "the battery holds 95 % at the arrival (94 % at the worse pace)");
  const std::string ends =
      R"("rules":[{"rule":"charge","verdict":"no_go","at_m":90}],"stations":[{"distance_m":50,"charge_percent":4,)"
      R"("charge_low_percent":0.5},{"distance_m":80,"charge_percent":1,"charge_low_percent":-1},)"
      R"({"distance_m":120.5,"charge_percent":-2,"charge_low_percent":-3}]})";
  EXPECT_EQ(
      battery_words(parsed(R"({"charge_percent":-53,"charge_low_percent":-88,"least_charge_percent":-53,)"
                           R"("least_charge_low_percent":-88,)" +
                           ends),
                    0),
      "the battery is empty at 120.5 m (at 80.0 m at the worse pace)");
  EXPECT_EQ(battery_words(parsed(R"({"charge_percent":3,"charge_low_percent":-3,"least_charge_percent":3,)"
                                 R"("least_charge_low_percent":-3,)" +
                                 ends),
                          1),
            "the battery holds 3.0 % at the arrival (empty at 80.0 m at the worse pace)");
}

TEST(DayWords, AWindowIsToldByWhatLiesWithinIt) {
  const auto told = [](const std::string& from, const std::string& to) {
    const planner::DepartureWindow window =
        told_window(parsed(R"({"from":")" + from + R"(","to":")" + to + R"("})"));
    return utc_words(window.from_ms) + ", " + utc_words(window.to_ms);
  };
  EXPECT_EQ(told("2016-03-22T08:58:16.875Z", "2016-03-22T16:39:20.100Z"),
            "2016-03-22 08:59 UTC, 2016-03-22 16:39 UTC");
  EXPECT_EQ(told("2016-03-22T08:58:16.875Z", "2016-03-22T08:58:50.999Z"),
            "2016-03-22 08:58:17 UTC, 2016-03-22 08:58:50 UTC");
}

}  // namespace
}  // namespace slipway::api
