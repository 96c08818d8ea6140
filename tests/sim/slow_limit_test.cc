#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/rover/stance.h"
#include "tests/sim/dynamic_drives.h"

namespace slipway::sim {
namespace {

struct Motion {
  const char* name;
  double tilt_deg, yaw_deg;
  DriveLeg leg;
};

class SlowLimit : public testing::TestWithParam<Motion> {};

// In steady motion the dynamic level agrees with the quasi-static one at any speed. The remaining difference
// is that unequal sinkage turns the suspension a little (a third of a degree on a climb of 15 deg), which
// shifts the wheels' loads by up to 1 %.
TEST_P(SlowLimit, IsTheQuasiStaticLevel) {
  const Motion& motion = GetParam();
  const RoverModel rover = light_suspension(six_wheeler());
  DynamicOptions options{.relative_tolerance = 1e-8, .feedback = Feedback::kNone, .sample_interval_s = 0.5};
  options.contact_points = 1;
  const Soil soil = sandy_loam();
  const Driven driven = drive(rover, plane(rad_from_deg(motion.tilt_deg)), soil, rad_from_deg(motion.yaw_deg),
                              {motion.leg}, options);
  const DriveSample& sample = driven.cruising();
  const FunctionGround ground = plane(rad_from_deg(motion.tilt_deg));
  const auto stance = settle(rover, ground, {sample.p_MB.x(), sample.p_MB.y(), sample.attitude.yaw_rad});
  ASSERT_TRUE(stance);
  QuasiStaticSolver solver(rover, kMars);
  const StationState balance = solver.solve(*stance, soil, motion.leg.command);
  ASSERT_TRUE(balance.moving());
  EXPECT_NEAR(sample.slip_ratio, balance.slip_ratio, 2e-4);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(sample.wheels[k].load_n, balance.wheels[k].load_n, 1.2) << k;
    EXPECT_NEAR(sample.wheels[k].sinkage_m, balance.wheels[k].sinkage_m, 8e-5) << k;
    EXPECT_NEAR(sample.wheels[k].current_a, balance.wheels[k].current_a, 4e-3) << k;
    EXPECT_NEAR(sample.wheels[k].slip_ratio, balance.wheels[k].slip_ratio, 3e-4) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Motions, SlowLimit,
    testing::Values(Motion{"level", 0.0, 0.0, straight(1.0)}, Motion{"up", 15.0, 0.0, straight(1.0)},
                    Motion{"up_fast", 15.0, 0.0, straight(1.0, 0.05)},
                    Motion{"up_slow", 15.0, 0.0, straight(0.7, 0.01)},
                    Motion{"down", 15.0, 180.0, straight(1.0)},
                    Motion{"backwards_up", 15.0, 180.0, straight(1.0, -0.04)},
                    Motion{"across", 10.0, 90.0, straight(1.0)}, Motion{"askew", 10.0, 40.0, straight(1.0)},
                    Motion{"arc", 0.0, 0.0, arc(2.0, 0.4)}, Motion{"turn", 0.0, 0.0, turn(2.0)}),
    [](const auto& named) { return std::string(named.param.name); });

// Wheels of 3 % of the rover's mass each turn the bogies on a climb. The balance shows this too where the
// wheels' weight acts at their own places (wheel_weight).
TEST(SlowLimitOfHeavyWheels, IsTheQuasiStaticLevelWithTheWheelsOwnWeight) {
  RoverModel rover = light_suspension(six_wheeler());
  rover.masses.wheel_kg.reset();
  DynamicOptions options{.relative_tolerance = 1e-8, .feedback = Feedback::kNone, .sample_interval_s = 0.5};
  options.contact_points = 1;
  const FunctionGround ground = plane(rad_from_deg(15.0));
  const Driven driven = drive(rover, plane(rad_from_deg(15.0)), sandy_loam(), 0.0, {straight(1.0)}, options);
  const DriveSample& sample = driven.cruising();
  double farthest_without = 0.0;
  for (const double wheel_weight : {0.0, 1.0}) {
    rover.wheel_weight = wheel_weight;
    const auto stance = settle(rover, ground, {sample.p_MB.x(), sample.p_MB.y(), sample.attitude.yaw_rad});
    ASSERT_TRUE(stance);
    QuasiStaticSolver solver(rover, kMars);
    const StationState balance = solver.solve(*stance, sandy_loam(), straight(1.0).command);
    ASSERT_TRUE(balance.moving());
    for (std::size_t k = 0; k < 6; ++k) {
      const double off = std::abs(sample.wheels[k].load_n - balance.wheels[k].load_n);
      if (wheel_weight == 0.0) farthest_without = std::max(farthest_without, off);
      if (wheel_weight == 1.0) {
        EXPECT_LT(off, 1.2) << k;
      }
    }
  }
  EXPECT_GT(farthest_without, 2.5);
}

}  // namespace
}  // namespace slipway::sim
