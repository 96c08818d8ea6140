#include "sim/rover/stance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "core/random.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

TEST(Stance, OnLevelGroundTheBodyIsAtRest) {
  const FunctionGround ground([](double, double) { return 2.5; });
  const auto stance = settle(six_wheeler(), ground, {1.0, 2.0, 0.7});
  ASSERT_TRUE(stance);
  EXPECT_NEAR(stance->p_MB.z(), 2.5, 1e-9);
  EXPECT_NEAR(stance->attitude.tilt_rad(), 0.0, 1e-9);
  EXPECT_NEAR(stance->rocker_rad, 0.0, 1e-9);
  EXPECT_NEAR(stance->belly_clearance_m, six_wheeler().belly_clearance_m, 1e-9);
}

TEST(Stance, OnAPlaneTheAttitudeIsThePlanesForEveryHeading) {
  const double slope = 0.2;  // rises to the east
  const FunctionGround ground([=](double x, double) { return std::tan(slope) * x; });
  const RoverModel rover = six_wheeler();
  for (double yaw = -3.0; yaw < 3.2; yaw += 0.5) {
    const auto stance = settle(rover, ground, {0.3, -0.4, yaw});
    ASSERT_TRUE(stance) << yaw;
    EXPECT_NEAR(stance->attitude.tilt_rad(), slope, 1e-7) << yaw;
    EXPECT_NEAR(stance->rocker_rad, 0.0, 1e-7) << yaw;
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(stance->normal_B[k].z(), 1.0, 1e-7);
  }
  const auto uphill = settle(rover, ground, {0.0, 0.0, 0.0});
  EXPECT_NEAR(uphill->attitude.pitch_rad, -slope, 1e-7) << "nose up is negative pitch";
  const auto across = settle(rover, ground, {0.0, 0.0, std::numbers::pi / 2});
  EXPECT_NEAR(across->attitude.roll_rad, -slope, 1e-7)
      << "driving north on ground that rises to the east: right side up";
}

TEST(Stance, EveryWheelTouchesRollingGround) {
  const FunctionGround ground(
      [](double x, double y) { return 0.12 * std::sin(2.1 * x + 0.3) * std::cos(1.7 * y); });
  const RoverModel rover = six_wheeler();
  for (int trial = 0; trial < 300; ++trial) {
    const Pose2 pose{10.0 * random_uniform(1, trial), 10.0 * random_uniform(2, trial),
                     6.28 * random_uniform(3, trial)};
    const auto stance = settle(rover, ground, pose);
    ASSERT_TRUE(stance);
    for (int k = 0; k < 6; ++k) {
      const Eigen::Vector3d p_M = stance->p_MB + stance->R_MB * stance->p_B_wheel[k];
      const auto point = ground.at(p_M.x(), p_M.y());
      EXPECT_NEAR((p_M.z() - point->height_m) * point->normal.z(), rover.wheels[k].radius_m, 1e-6);
    }
  }
}

TEST(Stance, ALiftedFrontWheelTurnsTheRockersAndTheBodyTakesHalf) {
  const double step = 0.05;
  const FunctionGround ground([=](double x, double y) { return x > 0.5 && y > 0.0 ? step : 0.0; });
  const auto stance = settle(six_wheeler(), ground, {0.0, 0.0, 0.0});
  ASSERT_TRUE(stance);
  EXPECT_LT(stance->rocker_rad, -0.01) << "the left rocker turns nose up";
  // The differential averages: the body pitches by half of what one rocker alone would.
  EXPECT_NEAR(stance->attitude.pitch_rad, stance->rocker_rad, 0.15 * std::abs(stance->rocker_rad));
}

TEST(Stance, NothingToStandOnIsNoStance) {
  const FunctionGround ground([](double, double) { return 0.0; }, 1.0);
  EXPECT_FALSE(settle(six_wheeler(), ground, {0.8, 0.0, 0.0}));
  EXPECT_TRUE(settle(six_wheeler(), ground, {0.0, 0.0, 0.0}));
}

TEST(Stance, ARockUnderTheBellyTakesClearance) {
  const FunctionGround ground([](double x, double y) { return 0.2 * std::exp(-(x * x + y * y) / 0.01); });
  const auto stance = settle(six_wheeler(), ground, {0.0, 0.0, 0.0});
  ASSERT_TRUE(stance);
  EXPECT_NEAR(stance->belly_clearance_m, six_wheeler().belly_clearance_m - 0.2, 2e-3);
}

}  // namespace
}  // namespace slipway::sim
