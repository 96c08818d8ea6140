#include "validation/laboratory/wheel_tests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/angle.h"
#include "validation/cuadriga/cuadriga_windows.h"

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

}  // namespace
}  // namespace slipway::validation
