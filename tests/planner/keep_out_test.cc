#include "planner/problem/keep_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "core/angle.h"
#include "core/random.h"
#include "tests/planner/plan_fixture.h"

namespace slipway::planner {
namespace {

const std::vector<Polygon> kSquare{{{10.0, 10.0}, {20.0, 10.0}, {20.0, 20.0}, {10.0, 20.0}}};

TEST(KeepOut, IsHitFromInsideAndByTheBodysCornerButNotBeyondIt) {
  const KeepOut keep_out(kSquare, *test_rover());  // body 2.0 by 1.45 m
  EXPECT_TRUE(keep_out.hits({15.0, 15.0, 0.3}));
  EXPECT_TRUE(keep_out.hits({9.01, 15.0, 0.0}));
  EXPECT_FALSE(keep_out.hits({8.99, 15.0, 0.0}));
}

TEST(KeepOut, ARoverAlongItsEdgePassesNearerThanOneAcrossIt) {
  const KeepOut keep_out(kSquare, *test_rover());
  EXPECT_FALSE(keep_out.hits({9.2, 15.0, 0.5 * std::numbers::pi}));
  EXPECT_TRUE(keep_out.hits({9.2, 15.0, 0.0}));
  EXPECT_FALSE(keep_out.hits_at_any_heading(9.2, 15.0));
  EXPECT_FALSE(keep_out.clear_at_any_heading(9.2, 15.0));
}

TEST(KeepOut, AgreesWithItsBoundsAtAnyHeading) {
  const KeepOut keep_out(kSquare, *test_rover());
  for (double x = 5.0; x < 12.0; x += 0.1) {
    for (double yaw = 0.0; yaw < 6.2; yaw += 0.3) {
      const bool hit = keep_out.hits({x, 9.0, yaw});
      EXPECT_TRUE(!keep_out.hits_at_any_heading(x, 9.0) || hit);
      EXPECT_TRUE(!keep_out.clear_at_any_heading(x, 9.0) || !hit);
    }
  }
}

Motion some_motion(std::uint64_t n) {
  const auto pose = [](std::uint64_t key) {
    return Pose2{8.0 * random_uniform(key, 0), 8.0 * random_uniform(key, 1),
                 wrapped_rad(6.28 * random_uniform(key, 2))};
  };
  return connect(pose(2 * n), pose(2 * n + 1), motion_limits(*test_rover()));
}

// The poses of a motion, closer than a millimetre at the body's corners.
std::vector<Pose2> poses_along(const Motion& motion) {
  std::vector<Pose2> poses;
  const auto turn = [&](const Pose2& start, double turn_rad) {
    for (int k = 0; k <= 4000; ++k)
      poses.push_back({start.x_m, start.y_m, start.yaw_rad + turn_rad * k / 4000.0});
  };
  turn(motion.from, motion.first_turn_rad);
  for (int k = 0; k <= 20'000; ++k) poses.push_back(motion.at(motion.length_m * k / 20'000.0));
  turn({motion.to.x_m, motion.to.y_m, motion.to.yaw_rad - motion.last_turn_rad}, motion.last_turn_rad);
  return poses;
}

TEST(KeepOut, AMotionHitsWhereAnyOfItsPosesDoesAndNowhereElse) {
  auto larger = std::make_shared<sim::RoverModel>(*test_rover());
  larger->body_length_m += 0.002;
  larger->body_width_m += 0.002;
  int hit = 0, clear = 0;
  for (std::uint64_t n = 0; n < 150; ++n) {
    const double x = 8.0 * random_uniform(n, 11), y = 8.0 * random_uniform(n, 12);
    const double size = 0.05 + 1.5 * random_uniform(n, 13);
    const std::vector<Polygon> polygons{
        {{x, y}, {x + size, y + 0.2 * size}, {x + 0.3 * size, y + 0.3 * size}, {x + 0.1 * size, y + size}}};
    const KeepOut keep_out(polygons, *test_rover()), nearly(polygons, *larger);
    const Motion motion = some_motion(n);
    const std::vector<Pose2> poses = poses_along(motion);
    const auto any = [&](const KeepOut& zones) {
      return std::any_of(poses.begin(), poses.end(), [&](const Pose2& pose) { return zones.hits(pose); });
    };
    const bool along = keep_out.hits_along(motion);
    (along ? hit : clear) += 1;
    EXPECT_TRUE(along || !any(keep_out)) << n;
    EXPECT_TRUE(!along || any(nearly)) << n;
    ASSERT_EQ(keep_out.first_hit(motion).has_value(), along) << n;
    if (along) {
      EXPECT_TRUE(nearly.hits(*keep_out.first_hit(motion, 0.001)) ||
                  *keep_out.first_hit(motion) == motion.to);
    }
  }
  EXPECT_GT(hit, 30);
  EXPECT_GT(clear, 30);
}

TEST(KeepOut, ATurnInPlaceSweepsItsCornersThroughWhatIsClearBeforeAndAfter) {
  const KeepOut keep_out(std::vector<Polygon>{{{1.1, -0.05}, {1.2, -0.05}, {1.2, 0.05}, {1.1, 0.05}}},
                         *test_rover());  // corners reach 1.235 m
  const Motion turn{.from = {0.0, 0.0, 0.0}, .to = {0.0, 0.0, 2.0}, .first_turn_rad = 2.0};
  const Motion away{.from = {0.0, 0.0, 0.0}, .to = {0.0, 0.0, 0.3}, .first_turn_rad = 0.3};
  EXPECT_FALSE(keep_out.hits(turn.from));
  EXPECT_FALSE(keep_out.hits(turn.to));
  EXPECT_TRUE(keep_out.hits_along(turn));
  EXPECT_FALSE(keep_out.hits_along(away));
}

TEST(KeepIn, IsLeftByTheBodysCornerAndByABodyBeyondItButNotWithin) {
  const KeepOut keep_in({}, *test_rover(), kSquare);  // body 2.0 by 1.45 m
  EXPECT_FALSE(keep_in.empty());
  EXPECT_FALSE(keep_in.hits({15.0, 15.0, 0.3}));
  EXPECT_FALSE(keep_in.hits({11.01, 15.0, 0.0}));
  EXPECT_TRUE(keep_in.hits({10.99, 15.0, 0.0}));
  EXPECT_FALSE(keep_in.hits({10.99, 15.0, 0.5 * std::numbers::pi}));
  EXPECT_TRUE(keep_in.hits({5.0, 15.0, 0.0}));
  EXPECT_TRUE(keep_in.hits_at_any_heading(5.0, 15.0));
  EXPECT_TRUE(keep_in.hits_at_any_heading(10.5, 15.0));
  EXPECT_TRUE(keep_in.clear_at_any_heading(15.0, 15.0, 3.0));
  EXPECT_FALSE(keep_in.clear_at_any_heading(15.0, 15.0, 4.0));
}

TEST(KeepIn, NoneOfSeveralMayBeLeft) {
  const KeepOut keep_in(
      {}, *test_rover(),
      std::vector<Polygon>{kSquare.front(), {{14.0, 10.0}, {30.0, 10.0}, {30.0, 20.0}, {14.0, 20.0}}});
  EXPECT_FALSE(keep_in.hits({17.0, 15.0, 0.0}));
  EXPECT_TRUE(keep_in.hits({12.0, 15.0, 0.0}));
  EXPECT_TRUE(keep_in.hits({25.0, 15.0, 0.0}));
}

TEST(KeepIn, AMotionLeavesWhereAnyOfItsPosesDoesAndNowhereElse) {
  auto larger = std::make_shared<sim::RoverModel>(*test_rover());
  larger->body_length_m += 0.002;
  larger->body_width_m += 0.002;
  int left = 0, within = 0;
  for (std::uint64_t n = 0; n < 150; ++n) {
    const double size = 5.0 + 7.0 * random_uniform(n, 14), x = -0.2 * size, y = -0.2 * size;
    const std::vector<Polygon> polygons{{{x, y},
                                         {x + 1.4 * size, y + 0.1 * size},
                                         {x + 1.2 * size, y + size},
                                         {x + 0.1 * size, y + 1.3 * size}}};
    const KeepOut keep_in({}, *test_rover(), polygons), nearly({}, *larger, polygons);
    const Motion motion = some_motion(n);
    const std::vector<Pose2> poses = poses_along(motion);
    const auto any = [&](const KeepOut& zones) {
      return std::any_of(poses.begin(), poses.end(), [&](const Pose2& pose) { return zones.hits(pose); });
    };
    const bool along = keep_in.hits_along(motion);
    (along ? left : within) += 1;
    EXPECT_TRUE(along || !any(keep_in)) << n;
    EXPECT_TRUE(!along || any(nearly)) << n;
    EXPECT_EQ(keep_in.first_hit(motion).has_value(), along) << n;
  }
  EXPECT_GT(left, 30);
  EXPECT_GT(within, 30);
}

TEST(KeepOut, ClearWithinAReachHoldsForEveryPlaceInIt) {
  const KeepOut keep_out(kSquare, *test_rover());
  EXPECT_TRUE(keep_out.clear_at_any_heading(8.0, 15.0));
  EXPECT_FALSE(keep_out.clear_at_any_heading(8.0, 15.0, 0.8));
  EXPECT_TRUE(keep_out.hits({8.79, 15.0, 0.55}));
}

}  // namespace
}  // namespace slipway::planner
