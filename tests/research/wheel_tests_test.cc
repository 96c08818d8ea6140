#include "research/validation/laboratory/wheel_tests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "api/files/soil_tests_csv.h"
#include "core/angle.h"
#include "research/validation/cuadriga/cuadriga_windows.h"
#include "research/validation/laboratory/ding_tests.h"
#include "research/validation/laboratory/grousered_fit.h"

namespace slipway::validation {
namespace {

const std::filesystem::path kData = std::filesystem::path(SLIPWAY_DATA_FOLDER) / "validation";

TEST(WheelConditions, RepeatsStayTogetherAndEveryAngleAndSpeedIsInBothHalves) {
  const auto conditions = load_wheel_conditions(kData / "single_wheel_smooth.csv");
  ASSERT_TRUE(conditions) << conditions.error().detail;
  EXPECT_EQ(conditions->size(), 63U);
  std::set<std::pair<double, double>> seen;
  std::set<double> angles[2], speeds[2];
  for (const WheelCondition& c : *conditions) {
    EXPECT_EQ(c.repeats.size(), 3U);
    EXPECT_TRUE(seen.insert({c.slip_angle_rad, c.commanded_rim_speed_m_s}).second);
    for (const WheelTest& test : c.repeats) {
      EXPECT_EQ(test.slip_angle_rad, c.slip_angle_rad);
      EXPECT_EQ(test.commanded_rim_speed_m_s, c.commanded_rim_speed_m_s);
    }
    angles[c.half == Half::kFit].insert(c.slip_angle_rad);
    speeds[c.half == Half::kFit].insert(c.commanded_rim_speed_m_s);
  }
  for (int half : {0, 1}) {
    EXPECT_EQ(angles[half].size(), 7U);
    EXPECT_EQ(speeds[half].size(), 9U);
  }
}

TEST(WheelConditions, UnitsAreMetresNewtonsAndRadians) {
  const auto conditions = load_wheel_conditions(kData / "single_wheel_smooth.csv");
  ASSERT_TRUE(conditions);
  const WheelCondition& locked = conditions->front();  // slip angle 0, rim at rest
  EXPECT_EQ(locked.slip_angle_rad, 0.0);
  EXPECT_NEAR(locked.mean(&WheelTest::slip_ratio), -1.0, 1e-3);
  EXPECT_NEAR(locked.mean(&WheelTest::sinkage_m), 0.050, 0.002);
  EXPECT_NEAR(locked.mean(&WheelTest::drawbar_pull_n), -38.8, 0.1);
  EXPECT_NEAR(locked.mean(&WheelTest::travel_speed_m_s), 0.01, 1e-4);
  EXPECT_NEAR(deg_from_rad(conditions->back().slip_angle_rad), 90.0, 1e-9);
}

TEST(WheelConditions, ScatterIsTheStandardDeviationOfTheRepeats) {
  WheelCondition condition;
  for (const double pull : {1.0, 2.0, 3.0}) {
    condition.repeats.emplace_back();
    condition.repeats.back().drawbar_pull_n = pull;
  }
  EXPECT_EQ(condition.mean(&WheelTest::drawbar_pull_n), 2.0);
  EXPECT_EQ(condition.scatter(&WheelTest::drawbar_pull_n), 1.0);
  condition.repeats.resize(1);
  EXPECT_EQ(condition.scatter(&WheelTest::drawbar_pull_n), 0.0);
}

TEST(CuadrigaWindows, EveryWindowIsInOneGroupOfItsGradient) {
  const auto windows = load_cuadriga_windows(kData / "cuadriga_windows.csv");
  ASSERT_TRUE(windows) << windows.error().detail;
  const auto groups = group_by_gradient(*windows, &CuadrigaWindow::slip_ratio, rad_from_deg(-28.0),
                                        rad_from_deg(28.0), rad_from_deg(4.0), 1);
  std::size_t count = 0;
  for (const GradientGroup& group : groups) {
    count += group.windows;
    EXPECT_GE(group.windows, group.logs);
    EXPECT_LE(group.interval.low, group.median);
    EXPECT_GE(group.interval.high, group.median);
    EXPECT_NEAR(group.highest_rad - group.lowest_rad, rad_from_deg(4.0), 1e-12);
  }
  EXPECT_EQ(count, 624U);
}

TEST(CuadrigaWindows, AJumpOfThePositionsIsDetected) {
  CuadrigaWindow window;
  window.distance_m = 2.0;
  window.gps_speed_m_s = 0.5;
  window.total_current_a = 10.0;
  window.charge_per_metre_as = 20.0;
  EXPECT_DOUBLE_EQ(window.duration_s(), 4.0);
  EXPECT_FALSE(window.position_jumped());
  window.distance_m = 40.0;
  window.charge_per_metre_as = 1.0;  // the same four seconds
  EXPECT_DOUBLE_EQ(window.duration_s(), 4.0);
  EXPECT_TRUE(window.position_jumped());
}

std::vector<gap::WheelObservation> shipped_tests(const char* name) {
  std::ifstream file(kData / name);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto tests = api::read_wheel_tests_csv(name, text);
  EXPECT_TRUE(tests) << tests.error().faults.front().message;
  return tests.value_or(std::vector<gap::WheelObservation>{});
}

// What `slipway estimate wheel` repeats the fits from are the tests that the comparisons are fitted to.
TEST(ShippedWheelTests, OfTheSandboxAreTheMeansOfItsConditions) {
  const auto tests = shipped_tests("sandbox_wheel_tests.csv");
  const auto wheels = load_sandbox_wheels(kData.parent_path());
  ASSERT_TRUE(wheels);
  std::size_t at = 0;
  for (const bool grousered : {true, false})
    for (const SandboxWheelTests& wheel : *wheels)
      for (const WheelCondition& c : wheel.conditions) {
        if (wheel.grousered != grousered) continue;
        ASSERT_LT(at, tests.size());
        const gap::WheelObservation& test = tests[at++];
        EXPECT_EQ(test.wheel, grousered ? "grousered" : "smooth");
        const double rim = c.mean(&WheelTest::rim_speed_m_s);
        EXPECT_NEAR(test.test.slip, travel_slip(rim, kPavlovTravel_m_s), 1e-5);
        EXPECT_NEAR(test.test.slip_angle_rad, c.slip_angle_rad, 1e-9);
        EXPECT_NEAR(test.test.load_n, c.mean(&WheelTest::load_n), 1e-3);
        const auto read = [&](gap::SoilChannel channel) { return test[channel].value.value_or(1e9); };
        EXPECT_NEAR(read(gap::SoilChannel::kDrawbarPull), c.mean(&WheelTest::drawbar_pull_n), 1e-3);
        EXPECT_NEAR(read(gap::SoilChannel::kLateralForce), -c.mean(&WheelTest::side_force_n), 1e-3);
        EXPECT_NEAR(read(gap::SoilChannel::kSinkage), c.mean(&WheelTest::sinkage_m), 1e-6);
      }
  EXPECT_EQ(at, tests.size());
}

TEST(ShippedWheelTests, OfDingAreThoseOfHisFigures) {
  const auto tests = shipped_tests("ding_2011_wheel_tests.csv");
  const auto figures = load_ding_tests(kData / "ding_2011.csv");
  ASSERT_TRUE(figures);
  ASSERT_EQ(tests.size(), figures->size());
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const DingTest& of = (*figures)[i];
    EXPECT_EQ(tests[i].wheel, of.wheel());
    EXPECT_EQ(tests[i].test.slip, of.slip);
    EXPECT_EQ(tests[i].test.load_n, 80.0);
    EXPECT_EQ(tests[i][gap::SoilChannel::kDrawbarPull].value, of.measured.pull_n);
    EXPECT_NEAR(*tests[i][gap::SoilChannel::kSinkage].value, 1e-3 * of.measured.sinkage_mm, 1e-9);
    EXPECT_EQ(tests[i][gap::SoilChannel::kTorque].value, of.measured.torque_nm);
  }
}

}  // namespace
}  // namespace slipway::validation
