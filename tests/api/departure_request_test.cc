// When a drive may begin, from the request to the answer.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "api/departure_setting.h"
#include "api/documents/departure.h"
#include "api/files/terrain_site.h"
#include "api/json/parse.h"
#include "api/requests/plan_request.h"
#include "core/angle.h"
#include "core/utc.h"
#include "yard_requests.h"

namespace slipway::api {
namespace {

const testing::YardRequests kYard("mer-class");
constexpr const char* kFourMetres = R"("path":[{"x_m":20,"y_m":30},{"x_m":24,"y_m":30}],"draws":24)";
// The sun rises in the east at 6 h and is overhead at 12 h.
constexpr const char* kSky =
    R"("sky":[{"at":"2026-07-01T00:00:00Z","sun_azimuth_deg":0,"sun_elevation_deg":-90},)"
    R"({"at":"2026-07-01T06:00:00Z","sun_azimuth_deg":90,"sun_elevation_deg":0},)"
    R"({"at":"2026-07-01T12:00:00Z","sun_azimuth_deg":90,"sun_elevation_deg":89.9},)"
    R"({"at":"2026-07-05T12:00:00Z","sun_azimuth_deg":90,"sun_elevation_deg":89.9}])";

std::string departing(const std::string& keys) {
  return std::string(kFourMetres) + R"(,"departure":{)" + keys + "}";
}

TEST(DepartureRequest, ACheckHasItsWindowsAndTheRulesOfTheDay) {
  const auto answer = kYard.checked(departing(
      std::string(R"("from":"2026-07-01T00:00:00Z","to":"2026-07-01T12:00:00Z","min_sun_deg":20,)") +
      R"("charge_percent":70,"min_charge_percent":30,)" + kSky));
  ASSERT_TRUE(answer) << answer.error().detail;
  const json::JsonValue& decision = *answer->find("decision");
  const json::JsonValue* const departures = decision.find("departures");
  ASSERT_NE(departures, nullptr);
  ASSERT_EQ(departures->find("windows")->elements.size(), 1U);
  // The sun is 20 deg high a little over an hour after 6 h.
  const std::string& from = departures->find("windows")->elements[0].find("from")->text;
  EXPECT_GE(from, "2026-07-01T07:15:00Z");
  EXPECT_LE(from, "2026-07-01T07:30:00Z");
  const json::JsonValue& best = *departures->find("best");
  EXPECT_GT(best.find("stations")->elements.size(), 2U);
  EXPECT_EQ(departures->find("tried")->elements.size(), 49U);
  int rules = 0;
  for (const json::JsonValue& rule : decision.find("rules")->elements)
    rules += rule.find("rule")->text == "sun" || rule.find("rule")->text == "charge" ? 1 : 0;
  EXPECT_EQ(rules, 2);
}

// A table of so many moments, one a minute, with as many digits as numbers have.
std::string sky_of(std::size_t moments) {
  constexpr std::int64_t kBegin_ms = 1'782'864'000'000;  // 2026-07-01
  std::string rows;
  for (std::size_t k = 0; k < moments; ++k)
    rows += fmt::format(
        R"({}{{"at":"{}","sun_azimuth_deg":123.45678901234567,"sun_elevation_deg":-12.345678901234567,)"
        R"("earth_azimuth_deg":123.45678901234567,"earth_elevation_deg":-12.345678901234567}})",
        k == 0 ? "" : ",", utc_text(kBegin_ms + 60'000 * static_cast<std::int64_t>(k)));
  return R"("from":"2026-07-01T01:00:00Z","sky":[)" + rows + "]";
}

TEST(DepartureRequest, AsManyMomentsAsAreAllowedFitABodyAndAreTheDescriptions) {
  constexpr std::size_t kMost = RequestLimits::kSkyMoments;
  const std::string full = departing(sky_of(kMost));
  EXPECT_LT(full.size(), RequestLimits::kBodyBytes);
  const auto answer = kYard.checked(full);
  EXPECT_TRUE(answer) << answer.error().detail;
  const auto more = kYard.checked(departing(sky_of(kMost + 1)));
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().faults.front().pointer, "/departure/sky");
  std::ifstream in(std::filesystem::path(SLIPWAY_DATA_FOLDER) / ".." / "api" / "openapi.json");
  const std::string description((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::size_t sky = description.find("\"sky\": {\n      \"type\": \"array\",\n      \"minItems\": 2");
  ASSERT_NE(sky, std::string::npos);
  EXPECT_LT(description.find(fmt::format("\"maxItems\": {},", kMost), sky), sky + 120);
}

TEST(DepartureRequest, AtNightItIsANoGoWithTheReason) {
  const auto answer = kYard.checked(departing(
      std::string(R"("from":"2026-07-01T01:00:00Z","to":"2026-07-01T03:00:00Z","min_sun_deg":0,)") + kSky));
  ASSERT_TRUE(answer) << answer.error().detail;
  const json::JsonValue& decision = *answer->find("decision");
  EXPECT_EQ(decision.find("verdict")->text, "no_go");
  bool said = false;
  for (const json::JsonValue& reason : decision.find("reasons")->elements)
    said |= reason.text.find("no departure") != std::string::npos;
  EXPECT_TRUE(said);
}

TEST(DepartureRequest, TimesMayHaveAZone) {
  const auto answer = kYard.checked(departing(
      std::string(R"("from":"2026-07-01T02:00:00+02:00","to":"2026-06-30T20:30:00-04:00",)") + kSky));
  ASSERT_TRUE(answer) << answer.error().detail;
  const json::JsonValue& tried = *answer->find("decision")->find("departures")->find("tried");
  EXPECT_EQ(tried.elements.front().find("departs")->text, "2026-07-01T00:00:00.000Z");
  EXPECT_EQ(tried.elements.back().find("departs")->text, "2026-07-01T00:30:00.000Z");
}

TEST(DepartureRequest, DirectionsThatNoGreatCircleJoinsAreRefused) {
  const auto answer = kYard.checked(
      departing(R"("from":"2026-07-01T02:00:00Z","sky":[)"
                R"({"at":"2026-07-01T00:00:00Z","sun_azimuth_deg":0,"sun_elevation_deg":-30},)"
                R"({"at":"2026-07-01T12:00:00Z","sun_azimuth_deg":180,"sun_elevation_deg":30}])"));
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().faults.front().pointer, "/departure/sky/1/at");
}

// On a polar map the north lies away from the south pole, in every direction.
TEST(MapNorth, IsThatOfThePlaceBesideAPoleToo) {
  const auto site = TerrainSite::open(std::filesystem::path(SLIPWAY_DATA_FOLDER) / "terrains" /
                                      "lunar_south_pole_synthetic");
  ASSERT_TRUE(site);
  for (const auto& [x, y] : {std::pair{8500.0, 12500.0}, {30.0, 40.0}, {-3.0, 4.0}, {5.0, -2.0}})
    EXPECT_NEAR(wrapped_rad(map_north_rad(**site, x, y) + std::atan2(x, y)), 0.0, x > 1000.0 ? 1e-4 : 0.25)
        << x;
}

TEST(DepartureRequest, EveryFaultHasItsPlace) {
  using Places = std::vector<std::string>;
  EXPECT_EQ(kYard.faults_of(departing(R"("from":"2026-07-01")")), Places{"/departure/from"});
  EXPECT_EQ(kYard.faults_of(departing(R"("from":"2026-02-30T00:00:00Z")")), Places{"/departure/from"});
  EXPECT_EQ(kYard.faults_of(departing(R"("from":"2026-07-01T00:00:00Z","to":"2026-06-01T00:00:00Z")")),
            Places{"/departure/to"});
  EXPECT_EQ(kYard.faults_of(
                departing(R"("from":"2026-07-01T00:00:00Z","to":"2027-07-01T00:00:00Z","every_min":1)")),
            (Places{"/departure/to", "/departure/every_min"}));
  EXPECT_EQ(kYard.faults_of(departing(R"("from":"2026-07-01T00:00:00Z","speed":1)")),
            Places{"/departure/speed"});
  EXPECT_EQ(kYard.faults_of(departing(std::string(R"("from":"2026-07-09T00:00:00Z",)") + kSky)),
            Places{"/departure/sky"});
  EXPECT_EQ(
      kYard.faults_of(departing(std::string(R"("from":"2026-07-01T00:00:00Z","min_earth_deg":5,)") + kSky)),
      Places{"/departure/sky"});
  EXPECT_EQ(testing::YardRequests("zhurong-class")
                .faults_of(departing(std::string(R"("from":"2026-07-01T00:00:00Z","min_charge_percent":5,)") +
                                     kSky)),
            Places{"/departure/min_charge_percent"});
}

// A fault of one key hides no fault of another, and a list that is too short none of its rows.
TEST(DepartureRequest, NoFaultHidesAnother) {
  using Places = std::vector<std::string>;
  EXPECT_EQ(kYard.faults_of(departing(R"("from":"1700-01-01T00:00:00Z","charge_percent":160)")),
            (Places{"/departure/charge_percent", "/departure/from"}));
  EXPECT_EQ(kYard.faults_of(departing(R"("from":"now","charge_percent":160,"min_sun":5)")),
            (Places{"/departure/from", "/departure/charge_percent", "/departure/min_sun"}));
  EXPECT_EQ(kYard.faults_of(
                departing(R"("from":"2026-07-01T00:00:00Z","sky":[{"at":"now","sun_azimuth_deg":500}])")),
            (Places{"/departure/sky", "/departure/sky/0/at", "/departure/sky/0/sun_azimuth_deg",
                    "/departure/sky/0/sun_elevation_deg"}));
  EXPECT_EQ(kYard.faults_of(departing(R"("from":"2026-07-01T00:00:00Z","sky":[])")),
            Places{"/departure/sky"});
}

// What is not known is open, and only what does not hold is broken.
TEST(DepartureRequest, WhatTheTableDoesNotReachIsOpenAndNotBroken) {
  const auto answer = kYard.checked(departing(
      R"("from":"2026-07-01T11:59:50Z","min_sun_deg":20,"light_left_h":1,"arrive_by":"2026-07-01T12:00:00Z","sky":[)"
      R"({"at":"2026-07-01T06:00:00Z","sun_azimuth_deg":90,"sun_elevation_deg":0},)"
      R"({"at":"2026-07-01T12:00:00Z","sun_azimuth_deg":90,"sun_elevation_deg":89}])"));
  ASSERT_TRUE(answer) << answer.error().detail;
  const json::JsonValue& nearest = *answer->find("decision")->find("departures")->find("nearest");
  const auto names = [&](const char* key) {
    std::string all;
    for (const json::JsonValue& name : nearest.find(key)->elements) all += name.text + " ";
    return all;
  };
  EXPECT_EQ(names("broken"), "arrival ");
  EXPECT_NE(names("open").find("sun light_left "), std::string::npos) << names("open");
  for (const json::JsonValue& rule : nearest.find("rules")->elements) {
    EXPECT_EQ(rule.find("words")->text.find("light_left"), std::string::npos);
    if (rule.find("rule")->text == "light_left") {
      EXPECT_EQ(rule.find("words")->text,
                "the table of the sky ends before the light that is left is known: give a longer one");
    }
  }
}

TEST(DepartureRequest, ReadsBackAsItIsWritten) {
  const std::string given =
      std::string(
          R"({"departure":{"from":"2026-07-01T00:00:00.500Z","to":"2026-07-01T03:00:00Z","every_min":10,)") +
      R"("charge_percent":70,"optical_depth":0.5,"air":{"coldest_c":-80,"warmest_c":-10},"min_charge_percent":30,)" +
      R"("min_sun_deg":5,"light_left_h":1.5,"arrive_by":"2026-07-02T00:00:00Z",)" + kSky + "}}";
  const auto read = [](const std::string& bytes) {
    const auto document = json::parse(bytes);
    std::vector<Fault> faults;
    json::ObjectReader reader(*document, "", faults);
    std::optional<DepartureRequest> departure;
    json::read_departure(reader, departure);
    EXPECT_TRUE(faults.empty()) << faults.front().message;
    json::Writer w;
    w.begin_object();
    json::write_departure(w, departure.value());
    w.end_object();
    return w.take();
  };
  const std::string once = read(given);
  EXPECT_EQ(read(once), once);
  EXPECT_EQ(once.find("sun_distance_au"), std::string::npos);
  const std::string nearer = read(
      std::string(given).replace(given.find(R"(,"sun_azimuth_deg":0)"), 0, R"(,"sun_distance_au":0.983)"));
  EXPECT_EQ(read(nearer), nearer);
  EXPECT_NE(nearer.find(R"("sun_distance_au":0.983)"), std::string::npos);
  EXPECT_NE(once.find("00:00:00.500Z"), std::string::npos);
}

}  // namespace
}  // namespace slipway::api
