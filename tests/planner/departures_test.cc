#include "planner/timing/departures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "planner/timing/drive_in_time.h"

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

bool holds(const TimedDrive& drive) {
  return std::all_of(drive.rules.begin(), drive.rules.end(),
                     [](const JudgedRule& rule) { return rule.verdict == Verdict::kGo; });
}

TEST(DriveInTime, ItsEnergyCloses) {
  Departure departure = a_day();
  departure.charge = 0.5;
  departure.optical_depth = 0.4;
  const sim::DrivePrediction prediction = two_hours();
  const DriveInTime drive(departure, &kCells, prediction, kNoProgress);
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
  EXPECT_GT(DriveInTime(departure, &kCells, south, kNoProgress).at(11 * kHour_ms).gained_wh,
            1.2 * DriveInTime(departure, &kCells, north, kNoProgress).at(11 * kHour_ms).gained_wh);
}

TEST(Departures, WindowsAreThoseOfEveryDepartureByItself) {
  Departure departure = a_day();
  departure.charge = 0.6;
  departure.rules.min_charge = 0.3;
  departure.rules.min_sun_rad = rad_from_deg(5.0);
  departure.rules.light_left_s = kHour_s;
  const sim::DrivePrediction prediction = two_hours();
  NoProgress progress;
  const Departures found = departures_of(departure, &kCells, prediction, progress);
  ASSERT_EQ(found.windows.size(), 1U);
  ASSERT_TRUE(found.best);
  const DriveInTime drive(departure, &kCells, prediction, kNoProgress);
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
  const Departures found = departures_of(departure, nullptr, prediction, progress);
  ASSERT_EQ(found.windows.size(), 4U);
  for (const DepartureWindow& window : found.windows) EXPECT_LT(window.to_ms - window.from_ms, 9 * kHour_ms);
  EXPECT_EQ(found.tried.size(), 4U);
}

TEST(DriveInTime, LightIsLeftUntilTheSunSetsToASecond) {
  Departure departure = a_day();
  departure.rules.light_left_s = 20.0 * kHour_s;
  const sim::DrivePrediction prediction = two_hours();
  const TimedDrive drive = DriveInTime(departure, nullptr, prediction, kNoProgress).at(9 * kHour_ms + 17'000);
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
  const Departures found = departures_of(departure, nullptr, stands, progress);
  EXPECT_EQ(found.windows.size(), 2U);
}

TEST(Departures, WithoutAWindowItIsANoGoWithTheReason) {
  Departure departure = a_day();
  departure.rules.arrive_by = kHour_ms;
  NoProgress progress;
  const sim::DrivePrediction prediction = two_hours();
  const Departures found = departures_of(departure, nullptr, prediction, progress);
  EXPECT_TRUE(found.windows.empty());
  EXPECT_FALSE(found.best);
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
  sim::PowerSupply hungry = kCells;
  hungry.driving_w = 160.0;
  NoProgress progress;
  const sim::DrivePrediction prediction = two_hours();
  const Departures found = departures_of(departure, &hungry, prediction, progress);
  EXPECT_TRUE(found.windows.empty());
  ASSERT_TRUE(found.best);
  ASSERT_TRUE(found.halt);
  EXPECT_GT(found.halt->hours, 0.0);
  EXPECT_TRUE(holds(*found.best));
  EXPECT_GE(found.best->least_charge_low, 0.4);
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
  const Departures found = departures_of(departure, nullptr, prediction, progress);
  DriveVerdict verdict;
  verdict.verdict = Verdict::kGo;
  judge_departures(found, verdict);
  EXPECT_EQ(verdict.verdict, Verdict::kUnknown);
  departure.rules.min_sun_rad.reset();
  EXPECT_EQ(departures_of(departure, nullptr, prediction, progress).windows.size(), 1U);
}

TEST(Departures, AnEmptyBatteryIsANoGoWithoutBeingAsked) {
  Departure departure = a_day();
  departure.to_ms = 0;
  departure.charge = 0.05;
  NoProgress progress;
  const sim::DrivePrediction prediction = two_hours();
  const Departures found = departures_of(departure, &kCells, prediction, progress);
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
  const Departures found = departures_of(departure, nullptr, prediction, progress);
  ASSERT_EQ(found.windows.size(), 1U);
  EXPECT_NEAR(static_cast<double>(found.windows[0].to_ms), 40 * 60'000.0, 2000.0);
  EXPECT_EQ(found.tried.size(), 3U);
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
  EXPECT_TRUE(holds(DriveInTime(departure, &kCells, prediction, kNoProgress).at(11 * kHour_ms)));
  departure.horizon = std::make_shared<dem::Horizon>(std::make_shared<dem::Terrain>(kGrid, heights, valid),
                                                     std::numeric_limits<double>::infinity());
  const TimedDrive hidden = DriveInTime(departure, &kCells, prediction, kNoProgress).at(11 * kHour_ms);
  EXPECT_FALSE(holds(hidden));
  EXPECT_EQ(hidden.lit_share, 0.0);
}

}  // namespace
}  // namespace slipway::planner
