#include "planner/timing/departures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "planner/judge/advice.h"
#include "planner/timing/drive_in_time.h"
#include "tests/planner/plan_fixture.h"

namespace slipway::planner {
namespace {

const NoProgress kNoProgress;
constexpr double kHour_s = 3600.0;
constexpr std::int64_t kHour_ms = 3'600'000;

// A day of 24 h: the sun rises at 6 h in the east, stands 60 deg high in the south at 12 h, sets at 18 h.
std::shared_ptr<const sky::Sky> a_few_days() {
  std::vector<sky::SkySample> samples;
  for (int minutes = -24 * 60; minutes <= 6 * 24 * 60; minutes += 5) {
    const double turned = 2.0 * std::numbers::pi * (minutes / 1440.0 - 0.5);
    const double tilt = rad_from_deg(30.0);
    const Eigen::Vector3d sun(-std::sin(turned), -std::cos(turned) * std::sin(tilt),
                              std::cos(turned) * std::cos(tilt));
    samples.push_back({minutes * 60'000LL, sky::bearing_of(sun), {}, 1.5});
  }
  return std::make_shared<sky::SkyTable>(std::move(samples));
}

// 100 m on level ground in two hours with 40 W of the motors; of 100 draws one of ten takes half as long
// again, with twice the energy.
sim::DrivePrediction two_hours() {
  sim::DrivePrediction drive;
  for (int k = 0; k <= 100; ++k) {
    sim::StationPrediction at;
    at.station.distance_m = k;
    at.station.pose = {10.0 + k, 50.0, 0.0};
    at.elapsed_s = 2.0 * kHour_s * k / 100.0;
    at.state.electric_power_w = 40.0;
    drive.stations.push_back(at);
  }
  drive.length_m = 100.0;
  drive.duration_s = 2.0 * kHour_s;
  drive.energy_j = 40.0 * drive.duration_s;
  for (int k = 0; k < 100; ++k) {
    sim::DrawFigures draw;
    draw.driven_m = 100.0;
    draw.duration_s = (k % 10 == 0 ? 1.5 : 1.0) * drive.duration_s;
    draw.energy_j = (k % 10 == 0 ? 2.0 : 1.0) * drive.energy_j;
    drive.drawn.push_back(draw);
  }
  return drive;
}

Departure a_day() {
  Departure departure;
  departure.from_ms = 0;
  departure.to_ms = 24 * kHour_ms;
  departure.sky = a_few_days();
  departure.day_s = 24.0 * kHour_s;
  return departure;
}

constexpr sim::PowerSupply kCells{
    .array_m2 = 2.0, .array_efficiency = 0.25, .battery_wh = 300.0, .standing_w = 20.0, .driving_w = 60.0};

sim::RoverModel powered_by(const sim::PowerSupply& supply) {
  sim::RoverModel rover;
  rover.power = supply;
  return rover;
}
const sim::RoverModel kOnCells = powered_by(kCells), kUnpowered;
// It needs more than the cells give in the morning.
const sim::RoverModel kHungry = [] {
  sim::PowerSupply supply = kCells;
  supply.driving_w = 160.0;
  return powered_by(supply);
}();

bool holds(const TimedDrive& drive) {
  return std::all_of(drive.rules.begin(), drive.rules.end(),
                     [](const JudgedRule& rule) { return rule.verdict == Verdict::kGo; });
}

TEST(DriveInTime, ItsEnergyCloses) {
  Departure departure = a_day();
  departure.charge = 0.5;
  departure.optical_depth = 0.4;
  const sim::DrivePrediction prediction = two_hours();
  const DriveInTime drive(departure, kOnCells, prediction, kNoProgress);
  for (const double hour : {1.0, 5.5, 9.0, 12.0, 17.0}) {
    const TimedDrive at = drive.at(std::llround(hour * 3.6e6), true);
    const double end = 0.5 + (at.gained_wh - at.used_wh - at.spilled_wh) / kCells.battery_wh;
    EXPECT_NEAR(at.charge_at_arrival, end, 1e-3) << hour;
    EXPECT_NEAR(at.used_wh, 200.0, 0.2);  // two hours at 100 W
    EXPECT_LE(at.charge_at_arrival_low, at.charge_at_arrival + 1e-9);
    EXPECT_EQ(at.stations.size(), 101U);
    EXPECT_EQ(at.arrives_ms - at.departs_ms, 2 * kHour_ms);
    EXPECT_EQ(at.arrives_late_ms - at.departs_ms, 3 * kHour_ms);
  }
  EXPECT_EQ(drive.at(kHour_ms).gained_wh, 0.0);
  EXPECT_GT(drive.at(11 * kHour_ms).gained_wh, 150.0);
}

TEST(DriveInTime, TheBodyThatLeansToTheSunGainsMore) {
  sim::DrivePrediction south = two_hours(), north = two_hours();
  for (auto& at : south.stations)
    at.state.attitude.roll_rad = rad_from_deg(15.0);  // left side up: leans south
  for (auto& at : north.stations) at.state.attitude.roll_rad = rad_from_deg(-15.0);
  const Departure departure = a_day();
  EXPECT_GT(DriveInTime(departure, kOnCells, south, kNoProgress).at(11 * kHour_ms).gained_wh,
            1.2 * DriveInTime(departure, kOnCells, north, kNoProgress).at(11 * kHour_ms).gained_wh);
}

TEST(Departures, WindowsAreThoseOfEveryDepartureByItself) {
  Departure departure = a_day();
  departure.charge = 0.6;
  departure.rules.min_charge = 0.3;
  departure.rules.min_sun_rad = rad_from_deg(5.0);
  departure.rules.light_left_s = kHour_s;
  const sim::DrivePrediction prediction = two_hours();
  NoProgress progress;
  const Departures found = departures_of(departure, kOnCells, prediction, progress);
  ASSERT_EQ(found.windows.size(), 1U);
  ASSERT_TRUE(found.is_kept());
  const DriveInTime drive(departure, kOnCells, prediction, kNoProgress);
  for (std::int64_t at = 0; at <= departure.to_ms; at += 120'000) {
    const bool inside = at >= found.windows[0].from_ms && at <= found.windows[0].to_ms;
    const auto distance =
        std::min(std::abs(at - found.windows[0].from_ms), std::abs(at - found.windows[0].to_ms));
    if (distance > 3000) {
      EXPECT_EQ(holds(drive.at(at)), inside) << static_cast<double>(at) / 3.6e6;
    }
  }
  // The slow pace takes three hours, and the sun sets at 18 h.
  EXPECT_LT(found.windows[0].to_ms, 14 * kHour_ms + 60'000);
  DriveVerdict verdict;
  verdict.verdict = Verdict::kGo;
  judge_departures(found, verdict);
  EXPECT_EQ(verdict.verdict, Verdict::kGo);
}

// Between two departures that are told of the night may lie.
TEST(Departures, NoWindowReachesOverANight) {
  Departure departure = a_day();
  departure.from_ms = 9 * kHour_ms;
  departure.to_ms = departure.from_ms + 72 * kHour_ms;
  departure.every_s = 24.0 * kHour_s;
  departure.rules.min_sun_rad = rad_from_deg(5.0);
  NoProgress progress;
  const sim::DrivePrediction prediction = two_hours();
  const Departures found = departures_of(departure, kUnpowered, prediction, progress);
  ASSERT_EQ(found.windows.size(), 4U);
  for (const DepartureWindow& window : found.windows) EXPECT_LT(window.to_ms - window.from_ms, 9 * kHour_ms);
  EXPECT_EQ(found.tried.size(), 4U);
}

TEST(DriveInTime, LightIsLeftUntilTheSunSetsToASecond) {
  Departure departure = a_day();
  departure.rules.light_left_s = 20.0 * kHour_s;
  const sim::DrivePrediction prediction = two_hours();
  const TimedDrive drive =
      DriveInTime(departure, kUnpowered, prediction, kNoProgress).at(9 * kHour_ms + 17'000);
  ASSERT_EQ(drive.rules.size(), 1U);
  // It arrives at 12 h and 17 s at the slow pace.
  EXPECT_NEAR(drive.rules[0].low * kHour_s, 6.0 * kHour_s - 17.0, 2.0);
}

// A sun that runs along the horizon goes behind a post that stands between two coarse directions.
TEST(DriveInTime, APostThatIsNarrowHidesALowSun) {
  const dem::GridGeometry grid{
      .rows = 200, .columns = 300, .west_m = 0.0, .north_m = 200.0, .cell_x_m = 1.0, .cell_y_m = 1.0};
  std::vector<float> heights(60'000, 0.0F);
  // 1.5 deg wide and 5.7 deg high, 100 m away at 92.5 deg.
  for (int row = 153; row < 156; ++row)
    for (int column = 150; column < 153; ++column)
      heights[static_cast<std::size_t>(row * 300 + column)] = 11.0F;
  Departure departure = a_day();
  departure.horizon = std::make_shared<dem::Horizon>(
      std::make_shared<const dem::Terrain>(grid, std::move(heights), std::vector<std::uint8_t>(60'000, 1)),
      1e9);
  const auto at = [](double azimuth_deg) {
    return sky::Bearing{rad_from_deg(azimuth_deg), rad_from_deg(2.0)};
  };
  departure.sky = std::make_shared<sky::SkyTable>(
      std::vector<sky::SkySample>{{0, at(90.0), {}, 1.0}, {24 * kHour_ms, at(96.0), {}, 1.0}});
  departure.rules.min_sun_rad = 0.0;
  departure.to_ms = 20 * kHour_ms;
  sim::DrivePrediction stands = two_hours();
  for (auto& station : stands.stations) station.station.pose = {50.5, 50.2, 0.0};
  NoProgress progress;
  const Departures found = departures_of(departure, kUnpowered, stands, progress);
  EXPECT_EQ(found.windows.size(), 2U);
}

TEST(Departures, WithoutAWindowItIsANoGoWithTheReason) {
  Departure departure = a_day();
  departure.rules.arrive_by = kHour_ms;
  NoProgress progress;
  const sim::DrivePrediction prediction = two_hours();
  const Departures found = departures_of(departure, kUnpowered, prediction, progress);
  EXPECT_TRUE(found.windows.empty());
  EXPECT_FALSE(found.is_kept());
  DriveVerdict verdict;
  verdict.verdict = Verdict::kGo;
  judge_departures(found, verdict);
  EXPECT_EQ(verdict.verdict, Verdict::kNoGo);
  ASSERT_FALSE(verdict.reasons.empty());
  EXPECT_NE(verdict.reasons.front().find("no departure"), std::string::npos) << verdict.reasons.front();
}

TEST(Departures, AHaltInTheSunLetsTheBatteryCharge) {
  Departure departure = a_day();
  departure.from_ms = 7 * kHour_ms;
  departure.to_ms = 8 * kHour_ms;
  departure.charge = 0.45;
  departure.rules.min_charge = 0.4;
  NoProgress progress;
  const sim::DrivePrediction prediction = two_hours();
  const Departures found = departures_of(departure, kHungry, prediction, progress);
  EXPECT_TRUE(found.windows.empty());
  ASSERT_TRUE(found.halt);
  ASSERT_TRUE(found.is_kept());
  EXPECT_GT(found.halt->hours, 0.0);
  EXPECT_TRUE(holds(found.drive));
  EXPECT_GE(found.drive.least_charge_low, 0.4);
}

// It is as long as the charge needs, to a minute: a longer one may come too late.
TEST(Departures, AHaltIsNoLongerThanItMustBe) {
  Departure departure = a_day();
  departure.from_ms = departure.to_ms = 7 * kHour_ms;
  departure.charge = 0.45;
  departure.rules.min_charge = 0.4;
  NoProgress progress;
  const sim::DrivePrediction prediction = two_hours();
  const Departures free = departures_of(departure, kHungry, prediction, progress);
  ASSERT_TRUE(free.halt);
  EXPECT_LT(free.drive.least_charge_low, 0.407);  // a minute gains 0.006
  departure.rules.arrive_by = free.drive.arrives_late_ms + 60'000;
  const Departures in_time = departures_of(departure, kHungry, prediction, progress);
  ASSERT_TRUE(in_time.halt);
  EXPECT_NEAR(in_time.halt->hours, free.halt->hours, 1.0 / 60.0);
  departure.rules.arrive_by = free.drive.arrives_late_ms - 120'000;
  EXPECT_FALSE(departures_of(departure, kHungry, prediction, progress).is_kept());
}

// The sun must stand high enough, and the rover must be there in time: half a minute lies between, wherever
// the moments fall at which the rules are looked at.
TEST(Departures, AWindowBetweenTwoLooksIsFound) {
  Departure departure = a_day();
  departure.rules.min_sun_rad = rad_from_deg(10.0);
  NoProgress progress;
  const sim::DrivePrediction prediction = two_hours();
  const Departures all_day = departures_of(departure, kUnpowered, prediction, progress);
  ASSERT_EQ(all_day.windows.size(), 1U);
  const std::int64_t opens = all_day.windows[0].from_ms;
  departure.rules.arrive_by =
      opens + 30'000 + DriveInTime(departure, kUnpowered, prediction, kNoProgress).at(opens).arrives_late_ms -
      opens;
  for (const std::int64_t earlier : {3'600'000, 3'615'000, 3'629'000, 3'650'000}) {
    departure.from_ms = opens - earlier;
    const Departures found = departures_of(departure, kUnpowered, prediction, progress);
    ASSERT_EQ(found.windows.size(), 1U) << earlier;
    EXPECT_NEAR(static_cast<double>(found.windows[0].from_ms - opens), 0.0, 1500.0) << earlier;
    EXPECT_NEAR(static_cast<double>(found.windows[0].to_ms - opens), 30'000.0, 1500.0) << earlier;
    EXPECT_TRUE(holds(found.drive)) << earlier;
  }
}

TEST(Departures, WhereTheSkyIsNotKnownItsRulesAreOpen) {
  Departure departure = a_day();
  departure.sky = std::make_shared<sky::SkyTable>(
      std::vector<sky::SkySample>{{0, {0.0, 1.0}, {}, 1.5}, {kHour_ms, {0.1, 1.0}, {}, 1.5}});
  departure.from_ms = departure.to_ms = kHour_ms / 2;
  departure.rules.min_sun_rad = 0.0;
  departure.rules.arrive_by = 9 * kHour_ms;
  NoProgress progress;
  const sim::DrivePrediction prediction = two_hours();
  const Departures found = departures_of(departure, kUnpowered, prediction, progress);
  DriveVerdict verdict;
  verdict.verdict = Verdict::kGo;
  judge_departures(found, verdict);
  EXPECT_EQ(verdict.verdict, Verdict::kUnknown);
  departure.rules.min_sun_rad.reset();
  EXPECT_EQ(departures_of(departure, kUnpowered, prediction, progress).windows.size(), 1U);
}

// What is broken before the table ends stays broken, and what holds without any sun behind it holds.
TEST(Departures, WhereTheTableEndsOnTheWayWhatIsKnownDecides) {
  Departure departure = a_day();
  departure.sky = std::make_shared<sky::SkyTable>(
      std::vector<sky::SkySample>{{0, {0.0, 0.1}, {}, 1.5}, {kHour_ms, {0.1, 0.1}, {}, 1.5}});
  departure.to_ms = 0;
  departure.rules.min_sun_rad = 0.5;
  departure.rules.min_charge = 0.1;
  sim::RoverModel rover = kOnCells;
  rover.power->battery_wh = 600.0;
  NoProgress progress;
  const sim::DrivePrediction prediction = two_hours();
  Departures found = departures_of(departure, rover, prediction, progress);
  ASSERT_EQ(found.drive.rules.size(), 2U);
  EXPECT_EQ(found.drive.rules[0].name, "charge");
  EXPECT_EQ(found.drive.rules[0].verdict, Verdict::kGo) << found.drive.rules[0].words;
  EXPECT_EQ(found.drive.rules[1].verdict, Verdict::kNoGo) << found.drive.rules[1].words;
  EXPECT_LT(found.drive.stations.size(), 60U) << "nothing is told of where the sun is not known";
  for (const TimedStation& at : found.drive.stations) {
    EXPECT_GE(at.late_ms, at.utc_ms);
    EXPECT_LE(at.late_ms, kHour_ms);
    EXPECT_LE(at.charge_low, at.charge);
  }
  departure.rules.min_charge = 0.9;
  found = departures_of(departure, rover, prediction, progress);
  EXPECT_EQ(found.drive.rules[0].verdict, Verdict::kNoGo) << "in the first hour already";
  departure.rules.min_charge = 0.55;
  found = departures_of(departure, rover, prediction, progress);
  EXPECT_EQ(found.drive.rules[0].verdict, Verdict::kUnknown) << found.drive.rules[0].words;
}

TEST(Departures, TheBestHasMostInTheBatteryAtTheArrival) {
  Departure departure = a_day();
  departure.charge = 0.6;
  departure.rules.min_sun_rad = rad_from_deg(20.0);
  NoProgress progress;
  const sim::DrivePrediction prediction = two_hours();
  const Departures found = departures_of(departure, kOnCells, prediction, progress);
  ASSERT_FALSE(found.windows.empty());
  for (const TimedDrive& tried : found.tried)
    if (holds(tried)) {
      EXPECT_LE(tried.charge_at_arrival_low, found.drive.charge_at_arrival_low + 1e-12);
    }
}

// The place of a broken rule is where it breaks first, so that a shorter drive is looked for before it.
TEST(DriveInTime, AChargeIsBrokenWhereItFirstFallsBelowItsLimit) {
  Departure departure = a_day();
  departure.charge = 0.5;
  departure.rules.min_charge = 0.4;
  const sim::DrivePrediction prediction = two_hours();
  const TimedDrive night = DriveInTime(departure, kOnCells, prediction, kNoProgress).at(0);
  ASSERT_EQ(night.rules.size(), 1U);
  EXPECT_EQ(night.rules[0].verdict, Verdict::kNoGo);
  // 30 Wh at up to 140 W over 1.5 h at the worse pace.
  ASSERT_TRUE(night.rules[0].at_m);
  EXPECT_GT(*night.rules[0].at_m, 5.0);
  EXPECT_LT(*night.rules[0].at_m, 20.0);
}

// A body that rocks from station to station has the light of all of them, however few are looked at.
TEST(DriveInTime, TheLightIsThatOfAllStations) {
  const auto drive_of = [](int stations, auto roll_deg) {
    sim::DrivePrediction drive = two_hours();
    const sim::StationPrediction first = drive.stations.front();
    drive.stations.clear();
    for (int k = 0; k <= stations; ++k) {
      sim::StationPrediction at = first;
      at.station.distance_m = 100.0 * k / stations;
      at.elapsed_s = 2.0 * kHour_s * k / stations;
      at.state.attitude.roll_rad = rad_from_deg(roll_deg(k));
      drive.stations.push_back(at);
    }
    return drive;
  };
  const Departure departure = a_day();
  const auto gained = [&](const sim::DrivePrediction& prediction) {
    return DriveInTime(departure, kOnCells, prediction, kNoProgress).at(11 * kHour_ms).gained_wh;
  };
  const double south = gained(drive_of(2000, [](int) { return 15.0; })),
               north = gained(drive_of(2000, [](int) { return -15.0; })),
               both = gained(drive_of(2000, [](int k) { return k % 6 == 0 ? 15.0 : -15.0; }));
  EXPECT_NEAR(both, (south + 5.0 * north) / 6.0, 2e-3 * both);
}

// At a pole cells that lie flat have next to nothing.
TEST(PowerSupply, UprightCellsHaveALowSunFromEverySide) {
  sim::PowerSupply supply{.array_efficiency = 0.3};
  supply.array_m2 = 1.0;
  const double up = std::sin(rad_from_deg(1.5));
  EXPECT_NEAR(supply.array_w(1361.0, up, 0.0), 0.3 * 1361.0 * up, 1e-9);
  supply.array_m2 = 0.0;
  supply.upright_array_m2 = std::numbers::pi;
  EXPECT_NEAR(supply.array_w(1361.0, up, 0.0), 0.3 * 1361.0 * std::cos(rad_from_deg(1.5)), 1e-9);
  EXPECT_EQ(supply.array_w(1361.0, 1.0, 0.0), 0.0) << "straight overhead";
}

TEST(Departures, AnEmptyBatteryIsANoGoWithoutBeingAsked) {
  Departure departure = a_day();
  departure.to_ms = 0;
  departure.charge = 0.05;
  NoProgress progress;
  const sim::DrivePrediction prediction = two_hours();
  const Departures found = departures_of(departure, kOnCells, prediction, progress);
  EXPECT_TRUE(found.windows.empty());
}

TEST(Departures, TheLastMomentIsTriedToo) {
  Departure departure = a_day();
  departure.from_ms = 0;
  departure.to_ms = 50 * 60'000;
  departure.every_s = 1800.0;
  departure.rules.arrive_by = 3 * kHour_ms + 40 * 60'000;  // the slow pace takes three hours
  NoProgress progress;
  const sim::DrivePrediction prediction = two_hours();
  const Departures found = departures_of(departure, kUnpowered, prediction, progress);
  ASSERT_EQ(found.windows.size(), 1U);
  EXPECT_NEAR(static_cast<double>(found.windows[0].to_ms), 40 * 60'000.0, 2000.0);
  EXPECT_EQ(found.tried.size(), 3U);
}

// On a body with a radius of 100 km a drive of 100 m towards the sun raises it by 0.057 deg.
TEST(DriveInTime, TheLevelTurnsAlongTheWay) {
  constexpr dem::GridGeometry kGrid{
      .rows = 100, .columns = 130, .west_m = 0.0, .north_m = 100.0, .cell_x_m = 1.0, .cell_y_m = 1.0};
  const std::size_t cells = 13'000;
  Departure departure = a_day();
  departure.horizon = std::make_shared<dem::Horizon>(
      std::make_shared<dem::Terrain>(kGrid, std::vector<float>(cells), std::vector<std::uint8_t>(cells, 1)),
      1e5);
  const sky::Bearing ahead{rad_from_deg(90.0), rad_from_deg(20.0)};
  departure.sky = std::make_shared<sky::SkyTable>(
      std::vector<sky::SkySample>{{0, ahead, {}, 1.0}, {24 * kHour_ms, ahead, {}, 1.0}});
  departure.rules.min_sun_rad = rad_from_deg(20.03);
  const TimedDrive drive = DriveInTime(departure, kOnCells, two_hours(), kNoProgress).at(0, true);
  EXPECT_NEAR(drive.stations.front().sun_over_horizon_rad, ahead.elevation_rad, 1e-9);
  EXPECT_NEAR(drive.stations.back().sun_over_horizon_rad - ahead.elevation_rad, 1e-3, 1e-6);
  EXPECT_FALSE(holds(drive));  // at the start
  departure.rules.min_sun_rad = rad_from_deg(19.99);
  EXPECT_TRUE(holds(DriveInTime(departure, kOnCells, two_hours(), kNoProgress).at(0)));
}

// What each rule that is no GO leaves to change, each once.
TEST(Advice, SaysWhatEachRuleLeavesToChange) {
  const auto otherwise = [](std::vector<JudgedRule> rules, int draws) {
    DriveVerdict verdict;
    verdict.verdict = Verdict::kGo;
    for (JudgedRule& rule : rules) add_rule(std::move(rule), verdict);
    advise({}, draws, verdict);
    return verdict.otherwise;
  };
  const auto rule = [](const char* name, Verdict verdict, bool over_draws = false) {
    return JudgedRule{.name = name, .verdict = verdict, .over_draws = over_draws};
  };
  EXPECT_EQ(otherwise({rule("sun", Verdict::kGo)}, 32), "");
  EXPECT_EQ(
      otherwise({rule("charge", Verdict::kNoGo), rule("sun", Verdict::kNoGo), rule("earth", Verdict::kNoGo)},
                32),
      "more charge, and another time of day");
  EXPECT_EQ(otherwise({rule("light_left", Verdict::kUnknown)}, 32), "a longer table of the sky");
  const std::string way = "another way or another goal (no shorter drive and no scout drive does)";
  EXPECT_EQ(otherwise({rule("embedding", Verdict::kUnknown, true)}, 32),
            "more draws of the ground than 32, or " + way);
  EXPECT_EQ(otherwise({rule("embedding", Verdict::kUnknown, true)}, 1000), way);
  EXPECT_EQ(otherwise({rule("slip_check", Verdict::kNoGo), rule("embedding", Verdict::kUnknown, true),
                       rule("arrival", Verdict::kNoGo)},
                      32),
            way + ", and a later arrival");
}

TEST(Departures, BehindAWallTheSunIsNotInSight) {
  constexpr dem::GridGeometry kGrid{
      .rows = 100, .columns = 130, .west_m = 0.0, .north_m = 100.0, .cell_x_m = 1.0, .cell_y_m = 1.0};
  std::vector<float> heights;
  for (int row = 0; row < kGrid.rows; ++row)
    for (int column = 0; column < kGrid.columns; ++column)
      heights.push_back(row > 60 ? 40.0F : 0.0F);  // to the south of the way
  const std::vector<std::uint8_t> valid(heights.size(), 1);
  Departure departure = a_day();
  departure.rules.min_sun_rad = 0.0;
  const sim::DrivePrediction prediction = two_hours();
  EXPECT_TRUE(holds(DriveInTime(departure, kOnCells, prediction, kNoProgress).at(11 * kHour_ms)));
  departure.horizon = std::make_shared<dem::Horizon>(std::make_shared<dem::Terrain>(kGrid, heights, valid),
                                                     std::numeric_limits<double>::infinity());
  const TimedDrive hidden = DriveInTime(departure, kOnCells, prediction, kNoProgress).at(11 * kHour_ms);
  EXPECT_FALSE(holds(hidden));
  EXPECT_EQ(hidden.lit_share, 0.0);
}

// What is told of a rule is plain, and what breaks it is told apart from its limit.
TEST(DriveInTime, RulesAreToldInPlainWords) {
  Departure departure = a_day();
  departure.rules.light_left_s = 1000.0 * kHour_s;
  departure.rules.arrive_by = 12 * kHour_ms + 30'000;
  const sim::DrivePrediction prediction = two_hours();
  const auto words_of = [&](std::int64_t departs_ms) {
    std::string all;
    for (const JudgedRule& rule :
         DriveInTime(departure, kUnpowered, prediction, kNoProgress).at(departs_ms).rules)
      all += rule.words + "\n";
    return all;
  };
  const std::string kept = words_of(8 * kHour_ms);
  EXPECT_NE(kept.find("h of light are left at the arrival, limit 1000 h"), std::string::npos) << kept;
  EXPECT_NE(
      kept.find("the rover arrives at 1970-01-01 10:00 UTC, at the slow pace at 1970-01-01 11:00 UTC, 60 min "
                "before the limit of 1970-01-01 12:00:30 UTC"),
      std::string::npos)
      << kept;
  EXPECT_NE(words_of(9 * kHour_ms + 45'000).find("15 s after the limit of"), std::string::npos);
  EXPECT_NE(words_of(9 * kHour_ms + 20'000).find("at the slow pace at 1970-01-01 12:00:20 UTC, 10 s before"),
            std::string::npos);
  departure.rules = {};
  departure.rules.min_sun_rad = rad_from_deg(20.0);
  NoProgress progress;
  const Departures found = departures_of(departure, kUnpowered, prediction, progress);
  ASSERT_FALSE(found.windows.empty());
  const std::string early = words_of(found.windows.front().from_ms - 2000);
  EXPECT_NE(early.find("falls below the limit of 20.00 deg"), std::string::npos) << early;
  EXPECT_EQ(early.find("to 20.00 deg at its lowest"), std::string::npos) << early;
  const DepartureWindow told = to_the_minute(found.windows.front());
  for (const std::int64_t end_ms : {told.from_ms, told.to_ms}) {
    EXPECT_EQ(end_ms % 60'000, 0);
    EXPECT_TRUE(holds(DriveInTime(departure, kUnpowered, prediction, kNoProgress).at(end_ms)));
  }
}

// Hour by hour through three days, as the equation has it.
TEST(MotorWarmth, WhatFollowsTheAirKeepsItsEquation) {
  Departure departure = a_day();
  departure.air = AirTemperature{-80.0, -10.0};
  departure.noon_ms = 12 * kHour_ms;
  const FollowingAir air(departure);
  EXPECT_NEAR(air.at_c(14 * kHour_ms), -10.0, 1e-9);
  EXPECT_NEAR(air.at_c(2 * kHour_ms), -80.0, 1e-9);
  constexpr double kTau_s = 5000.0, kStep_s = 5.0;
  const FollowingAir follows(departure, kTau_s);
  double motor_c = -45.0;
  for (std::int64_t ms = 0; ms < 72 * kHour_ms; ms += 5000) {
    if (ms >= 48 * kHour_ms && ms % kHour_ms == 0) {
      EXPECT_NEAR(motor_c, follows.at_c(ms), 0.1) << ms / kHour_ms;
    }
    motor_c += kStep_s / kTau_s * (air.at_c(ms) - motor_c);
  }
}

// The drive of two_hours() with wheels that each give 1 W to the ground.
sim::DrivePrediction with_wheels(sim::DrivePrediction drive) {
  for (sim::StationPrediction& at : drive.stations)
    for (int k = 0; k < 6; ++k)
      at.state.wheels.push_back({.rate_rad_s = 0.1, .torque_nm = k == 0 ? 20.0 : 10.0});
  return drive;
}

sim::RoverModel with_warm_motors() {
  sim::RoverModel rover = *test_rover();
  rover.drive.gear_efficiency = 0.5;
  rover.drive.thermal_resistance_k_w = 7.0;
  rover.drive.thermal_time_constant_s = 1200.0;
  return rover;
}

TEST(DriveInTime, AMotorIsWarmedByItsLossesAtEitherPace) {
  const sim::RoverModel rover = with_warm_motors();
  const sim::DrivePrediction prediction = with_wheels(two_hours());
  Departure departure = a_day();
  departure.air = AirTemperature{-20.0, -20.0};
  const TimedDrive drive = DriveInTime(departure, rover, prediction, kNoProgress).at(9 * kHour_ms, true);
  // Of the hardest-worked wheel half of what goes in is lost in the gear: 2 W of 4 W.
  const MotorLosses losses = motor_losses(rover, prediction.stations.front().state);
  EXPECT_GE(losses.most_w, 2.0);
  EXPECT_GT(losses.most_w, losses.least_w);
  for (const TimedStation& at : drive.stations) {
    const double usual_s = static_cast<double>(at.utc_ms - drive.departs_ms) / 1000.0;
    ASSERT_TRUE(at.motor_c && at.motor_slow_c);
    EXPECT_NEAR(*at.motor_c, -20.0 + 7.0 * losses.most_w * (1.0 - std::exp(-usual_s / 1200.0)), 1e-3);
    // One draw of ten takes twice the energy in one and a half times the time.
    EXPECT_NEAR(*at.motor_slow_c,
                -20.0 + 7.0 * losses.most_w * 4.0 / 3.0 * (1.0 - std::exp(-1.5 * usual_s / 1200.0)), 1e-3);
  }
  departure.air.reset();
  EXPECT_FALSE(
      DriveInTime(departure, rover, prediction, kNoProgress).at(9 * kHour_ms, true).stations.back().motor_c);
}

TEST(DriveInTime, MotorsMustStayBetweenTheirLimits) {
  sim::RoverModel rover = with_warm_motors();
  const sim::DrivePrediction prediction = with_wheels(two_hours());
  Departure departure = a_day();
  departure.air = AirTemperature{-80.0, 0.0};
  departure.noon_ms = 12 * kHour_ms;
  EXPECT_TRUE(DriveInTime(departure, rover, prediction, kNoProgress).at(2 * kHour_ms).rules.empty());
  rover.drive.min_temp_c = -55.0;
  const DriveInTime cold(departure, rover, prediction, kNoProgress);
  EXPECT_TRUE(holds(cold.at(14 * kHour_ms)));
  const TimedDrive at_night = cold.at(2 * kHour_ms);
  EXPECT_FALSE(holds(at_night));
  EXPECT_EQ(at_night.rules.front().name, "motor_cold");
  EXPECT_EQ(at_night.rules.front().at_m, 0.0);
  rover.drive.min_temp_c.reset();
  rover.drive.max_temp_c = 5.0;
  const DriveInTime hot(departure, rover, prediction, kNoProgress);
  EXPECT_FALSE(holds(hot.at(13 * kHour_ms)));
  EXPECT_EQ(hot.at(13 * kHour_ms).rules.front().name, "motor_hot");
  EXPECT_TRUE(holds(hot.at(2 * kHour_ms)));
}

}  // namespace
}  // namespace slipway::planner
