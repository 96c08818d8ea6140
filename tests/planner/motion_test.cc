#include "planner/problem/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "core/random.h"
#include "planner/judge/route_stations.h"

namespace slipway::planner {
namespace {

constexpr MotionLimits kLimits{.min_turn_radius_m = 1.5, .cruise_speed_m_s = 0.04, .turn_rate_rad_s = 0.03};

Pose2 some_pose(std::uint64_t n) {
  return {20.0 * random_uniform(n, 0), 20.0 * random_uniform(n, 1), wrapped_rad(6.28 * random_uniform(n, 2))};
}

TEST(Motion, EndsExactlyAtItsGoalPose) {
  for (std::uint64_t n = 0; n < 500; ++n) {
    const Pose2 to = some_pose(n + 1000);
    const Motion motion = connect(some_pose(n), to, kLimits);
    const Pose2 end = motion.at(motion.length_m);
    EXPECT_NEAR(end.x_m, to.x_m, 1e-9);
    EXPECT_NEAR(end.y_m, to.y_m, 1e-9);
    EXPECT_NEAR(wrapped_rad(end.yaw_rad + motion.last_turn_rad - to.yaw_rad), 0.0, 1e-9);
  }
}

TEST(Motion, NeverTurnsTighterThanTheRoverCan) {
  int arcs = 0;
  for (std::uint64_t n = 0; n < 500; ++n) {
    const Motion motion = connect(some_pose(n), some_pose(n + 1000), kLimits);
    EXPECT_LE(std::abs(motion.curvature_1_m), 1.0 / kLimits.min_turn_radius_m + 1e-12);
    arcs += motion.curvature_1_m != 0.0 ? 1 : 0;
  }
  EXPECT_GT(arcs, 50);
}

TEST(Motion, AQuarterCircleIsAsLongAsAQuarterOfItsCircumference) {
  const Motion motion = connect({0.0, 0.0, 0.0}, {5.0, 5.0, 0.5 * std::numbers::pi}, kLimits);
  EXPECT_NEAR(motion.curvature_1_m, 0.2, 1e-12);
  EXPECT_NEAR(motion.length_m, 2.5 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(motion.turned_rad(), 0.0, 1e-12);
}

TEST(Motion, ATurnOnTheSpotHasNoLength) {
  const Motion motion = connect({1.0, 2.0, 0.0}, {1.0, 2.0, 1.0}, kLimits);
  EXPECT_EQ(motion.length_m, 0.0);
  EXPECT_NEAR(duration_s(motion, kLimits), 1.0 / 0.03, 1e-9);
}

TEST(RouteStations, AreNoFurtherApartThanAskedAndTurnNoMoreThan15Degrees) {
  for (std::uint64_t n = 0; n < 50; ++n) {
    const Motion first = connect(some_pose(n), some_pose(n + 1000), kLimits);
    const Motion second = connect(first.to, some_pose(n + 2000), kLimits);
    const auto path = route_stations({first, second}, 0.29);
    double turned = 0.0;
    for (std::size_t i = 1; i < path.size(); ++i) {
      const double apart = path[i].distance_m - path[i - 1].distance_m;
      EXPECT_LE(apart, 0.29 + 1e-9);
      EXPECT_LE(std::hypot(path[i].pose.x_m - path[i - 1].pose.x_m, path[i].pose.y_m - path[i - 1].pose.y_m),
                apart + 1e-6);
      EXPECT_LE(std::abs(path[i].turned_rad), rad_from_deg(15.0) + 1e-9);
      EXPECT_TRUE(path[i].turning_in_place ? apart == 0.0 : apart > 0.0);
      turned += std::abs(path[i].turned_rad);
    }
    EXPECT_NEAR(turned, first.turned_rad() + second.turned_rad(), 1e-9);
    EXPECT_NEAR(path.back().distance_m, first.length_m + second.length_m, 1e-9);
    EXPECT_NEAR(path.back().pose.x_m, second.to.x_m, 1e-12);
    EXPECT_NEAR(wrapped_rad(path.back().pose.yaw_rad - second.to.yaw_rad), 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace slipway::planner
